// A live run that is changed from its page, in Chromium: cameras' controls, masks, the rig file, names.
// viewer_changes.mjs PAGE_FOLDER FOLDER SCENARIO ADDRESS, as viewer_page.mjs.
import assert from "node:assert/strict";
import { join } from "node:path";
import { browse } from "./viewer_browser.mjs";

const [, , page_folder, folder, scenario, address] = process.argv;
const phone = scenario.includes("phone");
const { page, sleep, text, eventually, soon, until, give_name, check_layout, done } = await browse(page_folder, phone);
const shot = (name) => page.screenshot({ path: join(folder, `${scenario}_${name}.png`) });
const first = page.locator("#cameras figure").first();
const found = async () => parseInt(await first.locator(".found").textContent());
const masks = async () => parseInt(await first.locator(".count").textContent()) || 0;
/** Mean grey of the first camera's image. */
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
  await eventually("the image is not darker", async () => (await brightness()) < 0.6 * before);
  await turn("exposure", 900);
  await eventually("what the camera refuses is not reported", async () => /does not take that exposure; it must be 0.02 to/.test(await first.locator(".refused").textContent()));
  await shot("refused");
  await eventually("what it has is not shown again", async () => (await first.locator('[data-dial="exposure"] input[type="number"]').inputValue()) === "0.5");
  await turn("exposure", 2);
  await eventually("the refusal stays", async () => !(await first.locator(".refused").isVisible()));
  await turn("gain", 1.5);
  await eventually("the image is not brighter", async () => (await brightness()) > 1.2 * before);
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
  await page.mouse.move(x + 2, y + 2); // it slips, which is not a mask
  await page.mouse.up();
  await eventually("a click does not take the mask away", async () => (await masks()) === lit);
  await eventually("its markers do not come back", async () => (await found()) > 0);
}

/** A mask of any shape, by its corners. */
async function draw_polygon() {
  const before = await masks();
  const all = await found();
  const canvas = await first.locator("canvas").boundingBox();
  const at = (x, y) => [canvas.x + x * canvas.width, canvas.y + y * canvas.height];
  const begin = async () => {
    for (const corner of [[0.01, 0.01], [0.99, 0.01], [0.99, 0.99]]) await page.mouse.click(...at(...corner));
  };
  await begin();
  await page.mouse.move(...at(0.5, 0.9));
  await shot("corners");
  await page.keyboard.press("Escape");
  await page.keyboard.press("Enter");
  await sleep(600);
  assert.equal(await masks(), before, "Escape does not leave the polygon");
  await begin();
  await page.keyboard.press("Enter");
  await eventually("Enter closes no polygon", async () => (await masks()) === before + 1);
  await eventually("a half of the image is masked, and as many are found", async () => (await found()) < all);
  await page.mouse.dblclick(...at(0.01, 0.99)); // outside of it: the first corner of another one, which one place cannot close
  await page.keyboard.press("Escape");
  for (const corner of [[0.01, 0.02], [0.01, 0.99]]) await page.mouse.click(...at(...corner));
  await page.mouse.dblclick(...at(0.97, 0.99));
  await eventually("a double click closes no polygon", async () => (await masks()) === before + 2);
  await eventually("what lies under two halves is found", async () => (await found()) <= 2);
  await shot("polygons");
  await page.mouse.click(...at(0.9, 0.3));
  await eventually("a click does not take a polygon away", async () => (await masks()) === before + 1);
  await page.mouse.click(...at(0.1, 0.5));
  await eventually("a click does not take the other away", async () => (await masks()) === before);
  await eventually("what was masked does not come back", async () => (await found()) >= 1);
  for (const corner of [[0.8, 0.05], [0.95, 0.05], [0.9, 0.2]]) await page.mouse.click(...at(...corner));
  await page.mouse.click(...at(0.801, 0.052)); // on the first corner
  await eventually("a click on the first corner closes no polygon", async () => (await masks()) === before + 1);
}

/** What is typed is not overwritten by what the server says in the meantime, and is sent when it is done. */
async function typed() {
  const field = first.locator('[data-dial="exposure"] input[type="number"]');
  const before = await field.inputValue();
  await field.click();
  await field.press("Control+a");
  await page.keyboard.type("3.2");
  await sleep(1500);
  assert.equal(await field.inputValue(), "3.2", "what is typed is overwritten");
  await field.press("Enter");
  await sleep(1500);
  assert.equal(await field.inputValue(), "3.2");
  await turn("exposure", before);
  await sleep(1000);
}

/** Who is there, who was, and the time, while all markers are hidden for a while. */
async function list() {
  const there = async () => parseInt(await text("#count"));
  const seconds = async () => {
    const [minutes, rest] = (await text("#now")).split(":");
    return 60 * Number(minutes) + Number(rest);
  };
  await page.click('#tabs [data-tab="list"]');
  await eventually("no person is in the list", async () => (await there()) > 3);
  const count = await there();
  const then = await seconds();
  await page.click("#pictures_tab");
  const cameras = await page.locator("#cameras figure").count();
  for (let i = 0; i < cameras; ++i) {
    const figure = page.locator("#cameras figure").nth(i);
    await figure.locator(".adjust").click();
    const canvas = await figure.locator("canvas").boundingBox();
    await page.mouse.move(canvas.x + 1, canvas.y + 1);
    await page.mouse.down();
    await page.mouse.move(canvas.x + canvas.width - 1, canvas.y + canvas.height - 1, { steps: 4 });
    await page.mouse.up();
    await figure.locator(".adjust").click();
  }
  await page.click('#tabs [data-tab="list"]');
  await eventually("who is hidden is counted as there", async () => (await there()) === 0);
  await eventually("who was there a moment ago is not listed", async () => (await page.locator(".row.gone").count()) >= Math.min(count, 4));
  await shot("gone");
  const chosen = page.locator(".row .name").first();
  const name = await chosen.textContent();
  await chosen.click();
  await eventually("who is gone for long stays", async () => (await page.locator(".row").count()) === 1);
  assert.equal(await page.locator(".row .name").first().textContent(), name, "who is selected does not stay");
  assert((await seconds()) > then + 5, "the clock stands still");
  assert.equal(await text("#total"), "live");
  await page.click("#play");
  const stood = await seconds();
  await eventually("no person says how far behind a pause is", async () => /^0:0[1-9]\.\d\d behind$/.test(await text("#total")));
  assert.equal(await seconds(), stood, "the clock runs on in a pause");
  await page.click("#live");
  await eventually("the clock does not catch up", async () => (await seconds()) > stood + 0.5 && (await text("#total")) === "live");
  await page.click("#pictures_tab");
  for (let i = 0; i < cameras; ++i) {
    const figure = page.locator("#cameras figure").nth(i);
    await figure.locator(".adjust").click();
    await figure.locator(".chip", { hasText: "Remove all" }).click();
    await figure.locator(".adjust").click();
  }
  await page.click('#tabs [data-tab="list"]');
  await eventually("no person comes back", async () => (await there()) > 3);
}

async function names() {
  const name = phone ? "head" : "left knee";
  const is_named = async () => (await page.locator(".row .name").allTextContents()).includes(name);
  const is_refused = async () => new RegExp(`is called ${name} and is seen now`).test(await text("#said"));
  await eventually("there are no markers", async () => (await page.locator(".row .name").count()) > 2);
  await eventually("the name is not in the list", async () => (await give_name(name)) && (await soon(is_named)));
  await shot("name");
  assert.match(await text("#naming label"), new RegExp(name));
  await page.keyboard.press("Escape");
  await until("the field stays", () => document.querySelector("#naming").hidden);
  // The one who has the name may have gone in the meantime; then another one takes it, and a third is refused.
  await eventually("two have one name", async () => (await give_name(name)) && (await soon(is_refused)));
  await shot("named");
  await page.keyboard.press("Escape");
}

async function cameras() {
  await page.click("#pictures_tab");
  await until("no camera is live", () => [...document.querySelectorAll("#cameras figure b")].some((b) => b.className === "live"));
  await shot("cameras");
  await first.locator(".adjust").click();
  await eventually("the panel does not specify what is found", async () => (await found()) > 0);
  await shot("panel");
  await check_layout();
  if (phone) return;
  await exposure_and_gain();
  await threshold();
  await typed();
  await draw_masks();
  await draw_polygon();
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
} else if (scenario === "list") {
  await list();
} else {
  await cameras();
}
await check_layout();
await done(scenario);
