// A live run's page in Chromium, for any kind of target: the list, the number or name of each track, hiding, naming and fit.
// viewer_kinds.mjs PAGE_FOLDER FOLDER SCENARIO ADDRESS, as viewer_page.mjs. SCENARIO begins with the frame: image, ground or space.
import assert from "node:assert/strict";
import { join } from "node:path";
import { browse } from "./viewer_browser.mjs";

const [, , page_folder, folder, scenario, address] = process.argv;
const { page, text, eventually, soon, give_name, look, check_layout, done } = await browse(page_folder, false);
const frame = scenario.split("_")[0];
const rows = () => page.locator(".row:not(.gone)").count();
const scene = () => page.evaluate(async () => await (await fetch("scene")).json());

async function list() {
  await page.click('#tabs [data-tab="list"]', { timeout: 90000 });
  await eventually("the list is empty", async () => parseInt(await text("#count")) > 0 && (await rows()) > 0);
  for (const name of await page.locator(".row .name").allTextContents()) assert.notEqual(name, "");
  await eventually("no track was seen", async () => (await page.locator(".row:not(.gone) .percent").allTextContents()).some((seen) => parseFloat(seen) > 0));
}

async function hide() {
  // On a busy machine tracks end while a row is clicked: then another one is tried.
  const is_hidden = async () => /[1-9]\d* hidden/.test(await text("#count"));
  const click_eye = async () => {
    const row = page.locator(".row:not(.gone)").first();
    try {
      await row.hover({ timeout: 3000 });
      await row.locator(".eye").click({ force: true, timeout: 3000 });
    } catch {
      return is_hidden();
    }
    return soon(is_hidden, 3);
  };
  await eventually("hiding does nothing", click_eye);
  await page.click("#none");
  await eventually("nothing is shown again", async () => !/hidden/.test(await text("#count")));
}

async function name() {
  // Not asked of the list, which has the rows in sight only, and a name moves its row.
  const is_named = async () => / Anna$/.test(await text("#naming label"));
  await eventually("a track cannot be named", async () => (await give_name("Anna")) && (await soon(is_named)));
  await page.keyboard.press("Escape");
}

/** The view shows all of the pitch, of the image or of the volume, and fits it again after it was zoomed. */
async function fit() {
  const { pitch, low, high } = await scene();
  if (frame === "ground") assert(pitch || (high[0] - low[0] > 2 && high[1] - low[1] > 2), "the page is not reported where the ground is");
  await page.click("#reset");
  const box = await page.locator("#stage").boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.wheel(0, -1500);
  await page.click("#reset");
  assert((await look("#stage")).colours > 8, "the view is empty");
}

await page.goto(address);
await list();
await hide();
if ((await scene()).can_change) await name();
await fit();
await check_layout();
await page.screenshot({ path: join(folder, `${scenario}.png`) });
await done(scenario);
