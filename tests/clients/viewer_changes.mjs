// A live run that is changed from its page, in Chromium: cameras' controls, masks, the rig file, names.
// viewer_changes.mjs PAGE_FOLDER FOLDER SCENARIO ADDRESS, as viewer_page.mjs.
import assert from "node:assert/strict";
import { join } from "node:path";
import { browse } from "./viewer_browser.mjs";

const [, , page_folder, folder, scenario, address] = process.argv;
const phone = scenario.includes("phone");
const { page, text, eventually, until, check_layout, done } = await browse(page_folder, phone);
const shot = (name) => page.screenshot({ path: join(folder, `${scenario}_${name}.png`) });
const first = page.locator("#cameras figure").first();
const found = async () => parseInt(await first.locator(".found").textContent());
const masks = async () => parseInt(await first.locator(".count").textContent()) || 0;
/** Mean grey of the first camera's picture. */
const brightness = () =>
  page.evaluate(() => {
    const canvas = document.querySelector("#cameras canvas");
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    let sum = 0;
    for (let i = 0; i < data.length; i += 4) sum += data[i];
    return (4 * sum) / data.length;
  });

async function turn(dial, value) {
  const field = first.locator(`[data-dial="${dial}"] input[type="number"]`);
  await field.fill(`${value}`);
  await field.press("Enter"); // the focus stays
}

async function exposure_and_gain() {
  const before = await brightness();
  await turn("exposure", 0.5);
  await eventually("the picture is not darker", async () => (await brightness()) < 0.6 * before);
  await turn("exposure", 900);
  await eventually("what the camera refuses is not told", async () => /does not take that exposure; it must be 0.02 to/.test(await first.locator(".refused").textContent()));
  await shot("refused");
  await eventually("what it has is not shown again", async () => (await first.locator('[data-dial="exposure"] input[type="number"]').inputValue()) === "0.5");
  await turn("exposure", 2);
  await eventually("the refusal stays", async () => !(await first.locator(".refused").isVisible()));
  await turn("gain", 1.5);
  await eventually("the picture is not brighter", async () => (await brightness()) > 1.2 * before);
}

async function threshold() {
  await eventually("no marker is found", async () => (await found()) > 3);
  await turn("threshold", 254);
  await eventually("the threshold changes nothing", async () => (await found()) < 3);
  await first.locator('[data-dial="threshold"] .chip').click();
  await eventually("automatic finds no more", async () => (await found()) > 3);
}

async function draw_masks() {
  const all = await found();
  await first.locator(".chip", { hasText: "Mask what is lit" }).click();
  await eventually("the lamps are not masked", async () => (await masks()) >= 2);
  await eventually("masked lamps stay", async () => (await found()) < all + 1);
  const lit = await masks();
  const canvas = await first.locator("canvas").boundingBox();
  const at = (x, y) => [canvas.x + x * canvas.width, canvas.y + y * canvas.height];
  await page.mouse.move(...at(0.02, 0.02));
  await page.mouse.down();
  await page.mouse.move(...at(0.98, 0.98), { steps: 5 });
  await page.mouse.up();
  await eventually("nothing was masked by hand", async () => (await masks()) === lit + 1);
  await eventually("markers under the mask are found", async () => (await found()) === 0);
  await shot("masks");
  const [x, y] = at(0.9, 0.04);
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 2, y + 2); // it slips, which is no mask
  await page.mouse.up();
  await eventually("a click does not take the mask away", async () => (await masks()) === lit);
  await eventually("its markers do not come back", async () => (await found()) > 0);
}

async function names() {
  const name = phone ? "head" : "left knee";
  await eventually("there are no markers", async () => (await page.locator(".row .name").count()) > 2);
  await page.locator(".row .name").first().click();
  await page.keyboard.press("n");
  await page.fill("#name_field", name);
  await shot("name");
  await page.keyboard.press("Enter");
  await eventually("the name is not in the list", async () => (await page.locator(".row .name").allTextContents()).includes(name));
  assert.match(await text("#naming label"), new RegExp(name));
  await page.keyboard.press("Escape");
  await until("the field stays", () => document.querySelector("#naming").hidden);
  await page.locator(".row .name", { hasNotText: name }).first().click();
  await page.fill("#name_field", name);
  await page.keyboard.press("Enter");
  await eventually("two have one name", async () => new RegExp(`is called ${name} and is seen now`).test(await text("#said")));
  await shot("named");
  await page.keyboard.press("Escape");
}

async function cameras() {
  await page.click("#pictures_tab");
  await until("no camera is live", () => [...document.querySelectorAll("#cameras figure b")].some((b) => b.className === "live"));
  await shot("cameras");
  await first.locator(".adjust").click();
  await eventually("the panel does not tell what is found", async () => (await found()) > 0);
  await shot("panel");
  await check_layout();
  if (phone) return;
  await exposure_and_gain();
  await threshold();
  await draw_masks();
  assert.match(await text(".save_bar"), /not saved/);
  await page.click("#save_rig");
  await eventually("it is not saved", async () => /All changes are in rig.toml/.test(await text(".save_bar")));
  await shot("saved");
}

await page.goto(address);
await until("nothing was loaded", () => document.body.dataset.time !== undefined);
if (scenario.includes("names")) {
  await page.keyboard.press("m");
  await names();
} else {
  await cameras();
}
await check_layout();
await done(scenario);
