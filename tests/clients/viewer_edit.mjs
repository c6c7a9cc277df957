// A take that is edited in the viewer's page, in Chromium. viewer_edit.mjs PAGE_FOLDER FOLDER SCENARIO ADDRESS, as viewer_page.mjs.
import assert from "node:assert/strict";
import { join } from "node:path";
import { browse } from "./viewer_browser.mjs";

const [, , page_folder, folder, scenario, address] = process.argv;
const phone = scenario.includes("phone");
const { page, text, eventually, until, look, check_layout, done } = await browse(page_folder, phone);
const has = (selector, name) => page.evaluate(([s, n]) => document.querySelector(s).classList.contains(n), [selector, name]);

/** The course of a track as the server has it: x by time. */
const course_x = (id) =>
  page.evaluate(async (track) => {
    const bytes = await (await fetch(`course?track=${track}`)).arrayBuffer();
    const n = new DataView(bytes).getUint32(24, true);
    return [...new Float32Array(bytes, 40 + 8 * n, n)];
  }, id);
const history = () => page.evaluate(async () => (await fetch("edits")).json());
const row_of = (name) => page.locator(".row .name", { hasText: new RegExp(`^${name}$`) });
async function select(...names) {
  await page.keyboard.press("m");
  await page.click("#none");
  for (const name of names) {
    await page.fill("#filter", name); // only rows in sight exist
    await row_of(name).click();
  }
  await page.fill("#filter", "");
  await page.locator("#filter").blur();
}
/** What the panel says once the program has answered. */
async function answered(what, pattern) {
  await eventually(`${what}: ${pattern}`, async () => pattern.test((await page.isVisible("#edit_said")) ? await text("#edit_said") : ""));
}
async function shot(name) {
  await page.screenshot({ path: join(folder, `${scenario}_${name}.png`) });
  await check_layout();
}
async function go_to_frame(frame) {
  const now = Number((await text("#frame_now")).split(" ")[1]);
  for (let i = now; i < frame; ++i) await page.keyboard.press("ArrowRight");
  for (let i = now; i > frame; --i) await page.keyboard.press("ArrowLeft");
  await eventually(`frame ${frame} is not reached`, async () => (await text("#frame_now")) === `frame ${frame}`);
}

async function swap_a_range() {
  const [a, b] = ["left_arm1", "right_forearm1"];
  await select(a, b);
  await go_to_frame(40);
  await page.keyboard.press("i");
  await go_to_frame(70);
  await page.keyboard.press("o");
  assert.equal(await page.inputValue("#range_first"), "40");
  assert.equal(await page.inputValue("#range_last"), "70");
  const ids = await page.evaluate(async (names) => {
    const { tracks } = await (await fetch("scene")).json();
    return names.map((name) => tracks.find((track) => track.label === name).id);
  }, [a, b]);
  const before = await Promise.all(ids.map(course_x));
  await page.keyboard.press("p");
  await until("the range is not in the plots", () => [...document.querySelectorAll(".marked")].some((band) => !band.hidden && band.clientWidth > 4));
  const plot = await look(".uplot canvas");
  await page.keyboard.press("w");
  assert.equal(await text("#act_words"), `${a} and ${b} exchange what they have in frames 40 to 70.`);
  assert.equal(await text("#act_command"), `marey edit edit.marey 'swap ${a} ${b} 40:70'`);
  await shot("swap");
  await page.keyboard.press("Enter");
  await answered("a swap", /^Done: swap left_arm1, right_forearm1, frames 40 to 70\.$/);
  const after = await Promise.all(ids.map(course_x));
  assert.deepEqual(after[0], before[0].map((x, i) => (i >= 40 && i <= 70 ? before[1][i] : x)));
  await eventually("the plot does not show the swap", async () => (await look(".uplot canvas")).digest !== plot.digest);
  await shot("swapped");
  await page.keyboard.press("Control+z");
  await answered("undo", /^Now as it was recorded\.$/);
  assert.deepEqual(await course_x(ids[0]), before[0]);
  await eventually("the plot does not show what is undone", async () => (await look(".uplot canvas")).digest === plot.digest);
  await page.keyboard.press("Control+Shift+Z");
  await answered("redo", /^Now as after 1: swap /);
  assert.deepEqual(await course_x(ids[0]), after[0]);
  await page.click("#undo");
  await answered("the button Undo", /^Now as it was recorded/);
}

async function mark_by_dragging() {
  await page.keyboard.press("u");
  assert.equal(await page.inputValue("#range_first"), "");
  const strip = await page.locator("#strip").boundingBox();
  await page.keyboard.down("Shift");
  await page.mouse.move(strip.x + 0.25 * strip.width, strip.y + 20);
  await page.mouse.down();
  await page.mouse.move(strip.x + 0.5 * strip.width, strip.y + 20, { steps: 5 });
  await page.mouse.up();
  const range = async () => [Number(await page.inputValue("#range_first")), Number(await page.inputValue("#range_last"))];
  const dragged = await range();
  assert(Math.abs(dragged[0] - 90) < 4 && Math.abs(dragged[1] - 180) < 4, `dragging on the strip marks ${dragged}`);
  const over = await page.locator(".u-over").first().boundingBox();
  await page.mouse.move(over.x + 0.7 * over.width, over.y + 20);
  await page.mouse.down();
  await page.mouse.move(over.x + 0.6 * over.width, over.y + 20, { steps: 5 });
  await page.mouse.up();
  await page.keyboard.up("Shift");
  const plotted = await range();
  assert(plotted[0] > dragged[1] && plotted[1] > plotted[0] + 20, `dragging in the plot marks ${plotted}`);
  await page.keyboard.press("u");
  await page.fill("#range_first", "30");
  await page.keyboard.press("Tab");
  assert.equal(await page.inputValue("#range_last"), "", "an end that no person set is open");
  await page.fill("#range_last", "9999");
  await page.keyboard.press("Tab");
  assert.match(await text("#edit_said"), /Range not set. Frames are from 0 to 359/);
  assert.equal(await page.inputValue("#range_last"), "", "what was refused is not shown");
  await page.fill("#range_last", "20");
  await page.keyboard.press("Tab");
  assert.match(await text("#edit_said"), /Frame 30 is after frame 20/);
  await page.fill("#range_last", "abc");
  await page.keyboard.press("Tab");
  assert.match(await text("#edit_said"), /A frame is a whole number/);
  await page.fill("#range_last", "359");
  await page.keyboard.press("Tab");
  assert.deepEqual(await range(), [30, 359]);
  assert(!(await page.isVisible("#edit_said")), "the refusal stays");
  await page.keyboard.press("u");
}

async function fill_and_see_what_it_is_off() {
  const worst = "right_thigh4"; // a marker with gaps
  await select(worst);
  await page.keyboard.press("p");
  await until("nothing is plotted", () => document.querySelectorAll(".uplot canvas").length === 3);
  await page.keyboard.press("f");
  await page.fill("#fill_longest", "2");
  await page.fill("#fill_within", "200");
  assert.match(await text("#act_words"), new RegExp(`^Gaps of ${worst} in all frames are filled, each by the method that does best .* over 2 s, .* over 200 mm, stay open`));
  await shot("fill");
  await page.click("#act_do");
  await answered("a fill", /^Done: fill .*: \d+ gaps?, \d+ frames: .*; expected to be off by [\d.]+( to [\d.]+)? mm\.$/);
  await page.keyboard.press("e");
  await page.locator(".edit.head summary").click();
  assert.match(await page.locator(".edit.head .gap b").first().textContent(), /^[\d.]+ mm$/);
  await page.locator(".edit.head .gap").first().click();
  await shot("filled");
}

async function rename_split_join() {
  await select("head1");
  await page.keyboard.press("n");
  await page.keyboard.type("fore head");
  assert.equal(await text("#act_command"), `marey edit edit.marey 'rename head1 "fore head"'`);
  await page.keyboard.press("Enter");
  await answered("a rename", /^Done: rename head1 to fore head\.$/);
  await eventually("the list has the old name", async () => (await row_of("fore head").count()) === 1 && (await row_of("head1").count()) === 0);
  await go_to_frame(80);
  await page.keyboard.press("s");
  await page.fill("#new_name", "later");
  await page.click("#act_do");
  await answered("a split", /^Done: split fore head at frame 80: later from there on\.$/);
  await eventually("the list has not both", async () => (await row_of("later").count()) === 1 && (await row_of("fore head").count()) === 1);
  await select("fore head", "later");
  await page.keyboard.press("j");
  await page.click("#other_way");
  assert.match(await text("#act_words"), /^later gets all that fore head has/);
  await page.keyboard.press("Enter");
  await answered("a join", /^Done: join later, fore head\.$/);
  assert.match(await text("#count"), /1 selected/);
  await page.keyboard.press("Delete");
  await page.keyboard.press("Enter");
  await answered("a deletion", /^Done: delete later\.$/);
  await eventually("what was deleted is there", async () => (await row_of("later").count()) === 0);
}

async function refused() {
  await select("left_arm1", "right_forearm1");
  await page.keyboard.press("n");
  assert.match(await text("#act_words"), /^Select one in the view or in the list; 2 are selected\.$/);
  assert(await page.isDisabled("#act_do"));
  await page.keyboard.press("j");
  await page.keyboard.press("Enter");
  await answered("two that are there at once", /^Not done\. "join left_arm1 right_forearm1": "left_arm1" and "right_forearm1" are both there in frame 0; split or delete one of them first\.$/);
  await shot("refused");
  await page.keyboard.press("Escape");
  assert(!(await page.isVisible("#act")));
  assert.match(await text("#count"), /2 selected/, "the first Escape takes back the action alone");
}

async function history_list() {
  await page.keyboard.press("e");
  const { edits, head } = await history();
  assert.equal(edits.length, 6, "swap (undone), fill, rename, split, join, delete");
  assert.equal(head, 6);
  assert.equal(await page.locator(".edit").count(), 7);
  assert.match(await page.locator('.edit[data-id="2"] em').textContent(), /from the recording/);
  assert(await has('.edit[data-id="1"]', "undone"));
  await page.locator('.edit[data-id="3"] .go').click();
  await until("a click in the list does not go there", () => document.querySelector(".edit.head").dataset.id === "3");
  assert.equal((await history()).head, 3);
  await shot("history");
  await page.locator('.edit[data-id="0"] .go').click();
  await until("the recording cannot be gone to", () => document.querySelector(".edit.head").dataset.id === "0");
  assert(await page.isDisabled("#undo"));
}

async function edit() {
  await swap_a_range();
  await mark_by_dragging();
  await fill_and_see_what_it_is_off();
  await rename_split_join();
  await refused();
  await history_list();
}

/** By touch, with buttons alone. */
async function edit_phone() {
  await select("left_arm1", "right_forearm1");
  await page.click('#tabs [data-tab="edits"]');
  await page.click("#mark_in");
  for (let frame = 1; frame <= 12; ++frame) {
    await page.click("#forth");
    await eventually("no step on", async () => (await text("#frame_now")) === `frame ${frame}`);
  }
  await page.click("#mark_out");
  await page.click("#do_swap");
  await shot("swap");
  await page.click("#act_do");
  await answered("a swap", /^Done: swap left_arm1, right_forearm1, frames 0 to 12\.$/);
  await shot("swapped");
  await page.click("#undo");
  await answered("undo", /^Now as it was recorded/);
}

await page.goto(address);
await until("nothing was loaded", () => Number(document.body.dataset.rows) > 0);
await until("there is no panel to edit", () => document.body.classList.contains("editing"));
await eventually("it is still being read", async () => !/reading/.test(await text("#facts")));
await check_layout();
await (phone ? edit_phone() : edit());
await check_layout();
await done(scenario);
