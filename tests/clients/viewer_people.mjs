// People who walk before a page, in Chromium, until the rig is written. viewer_people.mjs PAGE_FOLDER FOLDER SCENARIO ADDRESS, as
// viewer_page.mjs.
import assert from "node:assert/strict";
import { join } from "node:path";
import { browse } from "./viewer_browser.mjs";

const [, , page_folder, folder, scenario, address] = process.argv;
const { page, text, eventually, until, check_layout, done } = await browse(page_folder, false);
const shot = (name) => page.screenshot({ path: join(folder, `${scenario}_${name}.png`) });
/** How many pixels of the first camera's image have the colour of the found points. */
const points = () =>
  page.evaluate(() => {
    const canvas = document.querySelector("#cameras canvas");
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    let found = 0;
    for (let i = 0; i < data.length; i += 4) found += Math.abs(data[i] - 255) < 6 && Math.abs(data[i + 1] - 209) < 6 && Math.abs(data[i + 2] - 102) < 6;
    return found;
  });

await page.goto(address);
await eventually("no person says what to do", async () => /Walk through the whole volume/.test(await text("#wand h1")));
await eventually("nothing is said to be missing", async () => /Camera "\w+" has seen/.test(await text(".missing")));
await eventually("the points are not drawn", async () => (await points()) > 50);
await eventually("no part is covered", async () => /[1-9]\d*\s% of its picture/.test(await text(".coverage")));
await eventually("other cameras that saw them are not named", async () => /Together with .*cam04/.test(await text(".pairs")));
await shot("walking");
await check_layout();
await page.click("#enough");
await until("it does not compute", () => document.body.dataset.wand === "computing");
const phase = () => page.evaluate(() => document.body.dataset.wand);
for (let s = 0; s < 700 && /waving|computing/.test(await phase()); ++s) await page.waitForTimeout(1000); // as long as it takes
// Less than two seconds, over and over, are little to calibrate by: it is a rig, or the sentence why there is not one.
if ((await phase()) === "done") {
  assert.match(await text(".wand_head p"), /written to .*walked\.toml/);
  assert.equal(await page.locator(".result tr").count(), 4, "a head and three cameras");
  assert.match(await text(".result table"), /± [\d.]+ cm/);
} else {
  assert.match(await text("#wand h1"), /No rig results/);
  assert.match(await text(".wand_head p"), /walk through the whole volume|walk where|do not make one geometry/);
}
assert.ok(!(await page.isVisible("#set_ground")), "the floor is where people walked");
await page.waitForTimeout(1000);
await shot("done");
await done(scenario);
