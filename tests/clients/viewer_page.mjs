// The viewer's page in Chromium: loaded, inspected, every control used. viewer_page.mjs PAGE_FOLDER FOLDER SCENARIO ADDRESS
// Screenshots are left in FOLDER. Exits 1 with the first thing that is not as it should be.
import assert from "node:assert/strict";
import { join } from "node:path";
import { isDeepStrictEqual } from "node:util";
import { browse } from "./viewer_browser.mjs";

const [, , page_folder, folder, scenario, address] = process.argv;
const phone = scenario.includes("phone");
const { page, sleep, text, eventually, until, look, check_layout, done } = await browse(page_folder, phone);
const time = async () => Number(await page.evaluate(() => document.body.dataset.time));
const has = (selector, name) => page.evaluate(([s, n]) => document.querySelector(s).classList.contains(n), [selector, name]);

/** The time that is shown, once it is as it should be. */
async function time_where(what, holds) {
  let now = NaN;
  await eventually(what, async () => holds((now = await time())));
  return now;
}
/** The time that is shown, once it stands still. */
async function still_time(what) {
  let before = await time();
  await eventually(what, async () => {
    await sleep(300);
    const now = await time();
    const still = now === before;
    before = now;
    return still;
  });
  return before;
}

async function changes(what, act) {
  let before;
  await eventually(`the view does not stand still before ${what}`, async () => {
    const earlier = before;
    before = await look("#stage");
    return isDeepStrictEqual(before, earlier);
  });
  await act();
  await eventually(`${what} changes nothing in the view`, async () => !isDeepStrictEqual(await look("#stage"), before));
}

async function play_and_scrub() {
  const begin = await time();
  await page.click("#play");
  await time_where("it does not play", (now) => now > begin + 0.2);
  await page.click("#play");
  await still_time("it plays on");
  await page.keyboard.press("End");
  const end = await time_where("the key End goes nowhere", (now) => now > begin + 1);
  await page.keyboard.press("Home");
  const first = await time_where("the key Home goes nowhere", (now) => now < end);
  await page.click("#forth");
  const next = await time_where("no step on", (now) => now > first);
  await page.click("#back");
  await time_where("no step back", (now) => now < next);
  const strip = await page.locator("#strip").boundingBox();
  await page.mouse.click(strip.x + strip.width / 2, strip.y + strip.height / 2);
  await time_where("the strip's middle is not the recording's", (now) => Math.abs(now - (first + end) / 2) < 0.05 * (end - first));
  await page.keyboard.press("Home");
  await time_where("Home does not lead back", (now) => now === first);
  await page.selectOption("#speed", "4");
  await page.keyboard.press(" ");
  await time_where("four times as fast does not play", (now) => now > first + 0.4);
  await page.keyboard.press(" ");
  await page.keyboard.press("ArrowDown");
  assert.equal(await page.inputValue("#speed"), "2");
  await page.keyboard.press("ArrowUp");
  await page.keyboard.press("Home");
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("Shift+ArrowRight");
  await time_where("the arrows do not step", (now) => now > first + 0.9);
  await page.keyboard.press("ArrowLeft");
  await page.keyboard.press("Shift+ArrowLeft");
}

async function list_and_plots(space) {
  const names = page.locator(".row .name");
  const count = await names.count();
  assert(count > 3, "the list is empty");
  await names.nth(0).click();
  await names.nth(1).click();
  assert.match(await text("#count"), /2 selected/);
  await changes("hiding a track", () => page.locator(".row .eye").nth(0).click());
  assert.match(await text("#count"), /1 hidden/);
  const name = await names.nth(2).textContent();
  await page.fill("#filter", name);
  await eventually("the filter leaves all", async () => (await names.count()) < count);
  await page.fill("#filter", "");
  await page.click("#by_seen");
  const percents = (await page.locator(".percent").allTextContents()).map(Number);
  assert.deepEqual(percents, [...percents].sort((a, b) => a - b));
  await page.click("#by_name");
  await page.click('#tabs [data-tab="plot"]');
  await until("nothing is plotted", (n) => document.querySelectorAll(".uplot canvas").length === n, space ? 3 : 2);
  assert((await look(".uplot canvas")).colours > 20, "the plot is empty");
  await page.locator("#coordinates button", { hasText: "speed" }).click();
  await until("no speed is plotted", (n) => document.querySelectorAll(".uplot canvas").length === n, space ? 4 : 3);
  await page.locator("#coordinates button", { hasText: "speed" }).click();
  await until("speed stays plotted", (n) => document.querySelectorAll(".uplot canvas").length === n, space ? 3 : 2);
  const over = await page.locator(".u-over").first().boundingBox();
  const before = await time();
  await page.mouse.click(over.x + 0.8 * over.width, over.y + over.height / 2);
  await time_where("a click in the plot does not go there", (now) => now > before);
  await page.screenshot({ path: join(folder, `${scenario}_plots.png`) });
  await page.click('#tabs [data-tab="about"]');
  assert.match(await text("#about"), /Holds/);
  await page.keyboard.press("m");
  await page.click("#none");
  assert.doesNotMatch(await text("#count"), /selected|hidden/);
  await page.keyboard.press("a");
  assert.match(await text("#count"), /selected/);
  await page.keyboard.press("Escape");
}

async function buttons(space) {
  await changes("labels", () => page.click("#labels"));
  await page.keyboard.press("l");
  await page.keyboard.press("Shift+ArrowRight");
  await changes("trails", () => page.keyboard.press("t"));
  if (space) {
    for (const id of ["top", "front", "side", "reset"]) await changes(id, () => page.click(`#${id}`));
    await changes("cameras", () => page.click("#rig"));
    await page.keyboard.press("c");
    await changes("rays", () => page.click("#rays"));
    await page.screenshot({ path: join(folder, `${scenario}_rays.png`) });
    await changes("the key Y", () => page.keyboard.press("y"));
    await changes("the key 1", () => page.keyboard.press("1"));
    await changes("the key 0", () => page.keyboard.press("0"));
  }
  const stage = await page.locator("#stage").boundingBox();
  await page.mouse.move(stage.x + stage.width / 2, stage.y + stage.height / 2);
  await changes("the wheel", () => page.mouse.wheel(0, -400));
  await changes("dragging", async () => {
    await page.mouse.down();
    await page.mouse.move(stage.x + stage.width / 2 + 90, stage.y + stage.height / 2 + 30, { steps: 4 });
    await page.mouse.up();
  });
  await page.click("#reset");
  await changes("light", () => page.click("#theme"));
  assert(await has("html", "light"));
  await page.screenshot({ path: join(folder, `${scenario}_light.png`) });
  await page.keyboard.press("d");
  await page.keyboard.press("?");
  assert(await page.isVisible("dialog"));
  await page.locator("dialog button").click();
  assert(!(await page.isVisible("dialog")));
}

/** Over some mark the pointer says so, and a click selects it. */
async function pick() {
  const stage = await page.locator("#stage").boundingBox();
  for (let y = 60; y < stage.height - 20; y += 9) {
    for (let x = 30; x < stage.width - 20; x += 9) {
      const found = await page.evaluate(([cx, cy]) => {
        const view = document.querySelector(".view");
        view.dispatchEvent(new PointerEvent("pointermove", { clientX: cx, clientY: cy, bubbles: true }));
        return view.classList.contains("over_mark");
      }, [stage.x + x, stage.y + y]);
      if (!found) continue;
      await page.mouse.click(stage.x + x, stage.y + y);
      await eventually("a click on a mark selects nothing", async () => /1 selected/.test(await text("#count")));
      await page.keyboard.press("Escape");
      return;
    }
  }
  assert.fail("nothing in the view can be picked");
}

/** The image lies behind its tracks. */
async function live_image() {
  await eventually("the view has no image", async () => (await look("#view canvas")).colours > 40);
  await eventually("no rate is reported", async () => /Hz/.test(await text("#facts")));
  await page.screenshot({ path: join(folder, `${scenario}.png`) });
}

async function live() {
  await until("no image comes", () => [...document.querySelectorAll("#cameras figure b")].some((b) => b.className === "live"));
  if (phone) await page.click("#pictures_tab");
  await eventually("a camera's image is empty", async () => (await look("#cameras canvas")).colours > 10);
  await eventually("no camera is said to be stalled", async () => /stalled/.test(await text("#cameras")));
  await eventually("no images are said to be lost", async () => /7 lost/.test(await text("#cameras")));
  await page.click("#record");
  await until("nothing is recorded", () => document.querySelector("#record").getAttribute("aria-pressed") === "true");
  await page.keyboard.press("r");
  await until("recording does not end", () => document.querySelector("#record").getAttribute("aria-pressed") === "false");
  await page.click("#play");
  const paused = await still_time("it does not pause");
  await page.keyboard.press("ArrowLeft");
  await time_where("no step back", (now) => now < paused);
  await page.click("#live");
  await until("it does not continue", (t) => Number(document.body.dataset.time) > t, paused);
  const figure = page.locator("#cameras figure").first();
  const small = (await figure.boundingBox()).width;
  await figure.click();
  if (!phone) await eventually("an image does not grow", async () => (await figure.boundingBox()).width > small);
  await figure.click();
  await page.keyboard.press("m");
  await page.locator(".row .name").first().click();
  await page.keyboard.press("p");
  await until("nothing is plotted", () => document.querySelectorAll(".uplot canvas").length === 3);
  await page.keyboard.press("Escape");
  await page.keyboard.press("v");
  await sleep(2500);
  console.log(`${scenario}: capture to drawn, 95 % within ${await page.evaluate(() => document.body.dataset.latency)} ms; ${await text("#facts")}`);
}

await page.goto(address);
await until("nothing was loaded", () => Number(document.body.dataset.rows) > 0);
assert(!page.url().includes("token"), "the token stays in the address bar");
await eventually("the view has barely a colour", async () => (await look("#stage")).colours > 30);
await page.screenshot({ path: join(folder, `${scenario}.png`) });
await check_layout();
const space = scenario.includes("space") || scenario.includes("live");
if (scenario === "live_image") {
  await live_image();
} else if (scenario.includes("live")) {
  await live();
} else {
  await play_and_scrub();
  await list_and_plots(space);
  await buttons(space);
  if (!phone) await pick();
}
await check_layout();
await done(scenario);
