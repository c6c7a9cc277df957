// A skeleton's motion in Chromium: what is said of joints that were computed, left and right by name, bones that can be seen.
// viewer_bones.mjs PAGE_FOLDER FOLDER SCENARIO ADDRESS, as viewer_page.mjs.
import assert from "node:assert/strict";
import { join } from "node:path";
import { browse } from "./viewer_browser.mjs";

const [, , page_folder, folder, scenario, address] = process.argv;
const { page, text, eventually, check_layout, done } = await browse(page_folder, false);

/** How wide bones are across, px: the median over the rows of the view of their longest run in the bones' grey. */
async function width_of_bones() {
  const png = (await page.locator("#stage").screenshot()).toString("base64");
  return page.evaluate(async (data) => {
    const image = new Image();
    image.src = `data:image/png;base64,${data}`;
    await image.decode();
    const canvas = new OffscreenCanvas(image.width, image.height);
    const draw = canvas.getContext("2d");
    draw.drawImage(image, 0, 0);
    const { data: rgba } = draw.getImageData(0, 0, image.width, image.height);
    const grey = (at) => Math.min(rgba[at], rgba[at + 1], rgba[at + 2]) > 75 && Math.max(rgba[at], rgba[at + 1], rgba[at + 2]) - Math.min(rgba[at], rgba[at + 1], rgba[at + 2]) < 40;
    const runs = [];
    // The buttons over the view are omitted.
    for (let y = 60; y < image.height - 60; ++y) {
      let longest = 0;
      for (let x = 0, run = 0; x < image.width; ++x) {
        run = grey(4 * (y * image.width + x)) ? run + 1 : 0;
        longest = Math.max(longest, run);
      }
      if (longest > 0) runs.push(longest);
    }
    return runs.sort((a, b) => a - b)[runs.length >> 1] ?? 0;
  }, png);
}

await page.goto(address);
await eventually("the list is empty", async () => parseInt(await text("#count")) > 0);
assert.equal(await text("#by_seen"), "Present %");
assert.deepEqual([...new Set(await page.locator(".percent").allTextContents())], ["100"]);
await eventually("no left and right", async () => /left.*right.*middle/.test(await text("#legend")));
const colours = await page.evaluate(() => Object.fromEntries([...document.querySelectorAll(".row")].map((row) => [row.querySelector(".name").textContent, row.querySelector(".swatch").style.background])));
for (const [left, right] of [["Anna:LeftUpLeg", "Anna:RightUpLeg"], ["Anna:LARM", "Anna:RARM"], ["Anna:l_hand", "Anna:r_hand"], ["Anna:lfoot", "Anna:rfoot"]]) {
  assert.equal(colours[left], colours["Anna:LeftUpLeg"], `${left} is not left`);
  assert.equal(colours[right], colours["Anna:RightUpLeg"], `${right} is not right`);
}
assert.equal(colours["Anna:lowerback"], colours["Anna:Hips"], "what begins with an l by chance has a side");
assert.equal(new Set([colours["Anna:LeftUpLeg"], colours["Anna:RightUpLeg"], colours["Anna:Hips"]]).size, 3);
await page.screenshot({ path: join(folder, `${scenario}.png`) });
await page.click('#tabs [data-tab="about"]');
assert.match(await text("#about"), /computed/);
assert.match(await text("#about"), /holds no calibration, so that neither they nor rays can be shown/);
await page.click("#front");
await page.click("#labels");
while ((await text("#trails")) !== "Trails") await page.keyboard.press("t");
await eventually("bones are as thin as a hair", async () => (await width_of_bones()) >= 3);
await check_layout();
await page.screenshot({ path: join(folder, `${scenario}_front.png`) });
await done(scenario);
