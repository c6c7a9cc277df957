// A wand that is waved before a page, in Chromium, until the rig is written. viewer_wand.mjs PAGE_FOLDER FOLDER SCENARIO ADDRESS, as
// viewer_page.mjs.
import assert from "node:assert/strict";
import { join } from "node:path";
import { browse } from "./viewer_browser.mjs";

const [, , page_folder, folder, scenario, address] = process.argv;
const phone = scenario.includes("phone");
const { page, text, eventually, until, check_layout, done } = await browse(page_folder, phone);
const shot = (name) => page.screenshot({ path: join(folder, `${scenario}_${name}.png`) });
/** Whether the image has pixels of the wand's colour, and of the parts that are covered. */
const has_colour = ([r, g, b]) =>
  page.evaluate(([r, g, b]) => {
    const canvas = document.querySelector("#cameras canvas");
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    for (let i = 0; i < data.length; i += 4)
      if (Math.abs(data[i] - r) < 12 && Math.abs(data[i + 1] - g) < 12 && Math.abs(data[i + 2] - b) < 12) return true;
    return false;
  }, [r, g, b]);

/** The first camera, whose image is masked but for a strip below: the wand is not seen enough before the mask is gone. */
async function set_camera() {
  const first = page.locator("#cameras figure").first();
  const masks = (count) => eventually(`there are not ${count} masks`, async () => (await first.locator(".count").textContent()) === count);
  await first.locator(".adjust").click();
  await masks("1");
  await first.locator('[data-dial="gain"] input[type="number"]').fill("1.2");
  await page.keyboard.press("Enter");
  const canvas = await first.locator("canvas").boundingBox();
  const click = (x, y) => page.mouse.click(canvas.x + x * canvas.width, canvas.y + y * canvas.height);
  for (const corner of [[0.02, 0.94], [0.1, 0.94], [0.06, 0.99]]) await click(...corner);
  await page.keyboard.press("Enter");
  await masks("2");
  await shot("controls");
  await check_layout();
  await click(0.5, 0.3);
  await masks("1");
  await first.locator(".adjust").click();
}

await page.goto(address);
await eventually("no person says what to do", async () => /Wave the wand/.test(await text("#wand h1")));
if (!scenario.includes("enough")) await set_camera();
await eventually("the wand is not drawn", () => has_colour([255, 209, 102]));
await eventually("no part is covered", async () => /[1-9]\d*\s% of its picture/.test(await text(".coverage")));
await eventually("no person says with whom it was seen", async () => /cam2/.test(await text(".pairs")));
await shot("waving");
await check_layout();
if (scenario.includes("enough")) {
  await eventually("no camera has seen enough", async () => (await page.locator(".waved.enough").count()) > 0);
  await shot("enough");
  await page.click("#enough");
}
const phase = () => page.evaluate(() => document.body.dataset.wand);
for (let s = 0; s < 200 && /waving|computing/.test(await phase()); ++s) await page.waitForTimeout(1000); // as long as it takes
await until("it is not calibrated", () => document.body.dataset.wand === "done");
assert.match(await text(".grade"), /excellent|good|fair|poor/);
assert.match(await text(".wand_head p"), /written to .*waved\.toml/);
assert.equal(await page.locator(".result tr").count(), 6, "a head, four cameras, and all");
await eventually("the rig is not shown", async () => /Cameras/.test(await text("#rig")) && (await page.isVisible("#rig")));
await page.waitForTimeout(1000);
await shot("done");
assert.match(await text(".floor p"), /Lay the L-frame down/);
await page.click("#set_ground");
await eventually("no person says that the L-frame is inspected", async () => /Looking at the L-frame/.test(await text(".floor p")));
await eventually("the ground is not set", async () => /The ground is set; the L-frame fits to [\d.]+ mm/.test(await text(".floor p")));
await page.waitForTimeout(1000);
await shot("ground");
await check_layout();
await done(scenario);
