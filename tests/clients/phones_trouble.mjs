// A phone that is turned, whose line is dead, whose network changes, that sleeps, whose page is hidden, and is opened twice: Chromium
// whose camera is a canvas, on a line that can be cut.
//
//   node phones_trouble.mjs PAGE_FOLDER ADDRESS CAMERA       prints what each page said, and how many images it took, as JSON
import assert from "node:assert/strict";
import { createRequire } from "node:module";
import { connect, createServer } from "node:net";
import { join } from "node:path";

const [page_folder, address, camera] = process.argv.slice(2);
const { chromium } = createRequire(join(page_folder, "package.json"))("playwright-core");
const sleep = (ms) => new Promise((done) => setTimeout(done, ms));

/** Between the phone and Marey: `dead` holds all back, `cut` ends what there is. */
class Line {
  pairs = [];
  dead = false;
  constructor(port) {
    this.server = createServer((from) => {
      const to = connect(port, "127.0.0.1");
      this.pairs.push([from, to]);
      from.on("data", (bytes) => this.dead || to.write(bytes));
      to.on("data", (bytes) => this.dead || from.write(bytes));
      for (const [one, other] of [[from, to], [to, from]]) one.on("error", () => {}).on("close", () => this.dead || other.destroy());
    });
  }
  listen = () => new Promise((done) => this.server.listen(0, "127.0.0.1", () => done(this.server.address().port)));
  cut() {
    for (const pair of this.pairs) for (const one of pair) one.destroy();
    this.pairs = [];
  }
  end() {
    this.cut();
    this.server.close();
  }
}

/** A camera that can be turned. */
function draw_camera() {
  navigator.mediaDevices.getUserMedia = async () => {
    const canvas = document.createElement("canvas");
    const context = canvas.getContext("2d");
    window.turn = (turned) => ([canvas.width, canvas.height] = turned ? [180, 320] : [320, 180]);
    window.turn(false);
    const draw = () => {
      context.fillStyle = `hsl(${performance.now() / 10} 80% 50%)`;
      context.fillRect(0, 0, canvas.width, canvas.height);
      requestAnimationFrame(draw);
    };
    draw();
    return canvas.captureStream(30);
  };
}

const given = new URL(address);
const line = new Line(Number(given.port));
given.hostname = "127.0.0.1";
given.port = String(await line.listen());
const browser = await chromium.launch({ executablePath: "/usr/bin/chromium", args: ["--no-sandbox", "--ignore-certificate-errors"] });

async function phone() {
  const context = await browser.newContext({ viewport: { width: 390, height: 844 }, ignoreHTTPSErrors: true });
  await context.addInitScript(draw_camera);
  const page = await context.newPage();
  const wrong = [];
  page.on("pageerror", (error) => wrong.push(error.message));
  await page.goto(`${given}&camera=${camera}`);
  await page.waitForSelector(`#camera option[value=${camera}]`, { state: "attached" });
  await page.selectOption("#camera", camera);
  await page.click("#start");
  await says(page, /^This phone is camera/);
  return { page, wrong, first: await page.evaluate(() => sequence) };
}
async function says(page, what, seconds = 25) {
  for (const end = Date.now() + 1000 * seconds; Date.now() < end; await sleep(100)) if (what.test(await page.textContent("#problem"))) return;
  assert.fail(`${what} is not said: ${await page.textContent("#problem")}`);
}
/** Images go out again. */
async function sends(page) {
  const before = await page.evaluate(() => sequence - omitted);
  for (const end = Date.now() + 25000; Date.now() < end; await sleep(100)) if ((await page.evaluate(() => sequence - omitted)) > before + 10) return;
  assert.fail(`nothing is sent: ${await page.textContent("#figures")}`);
}

const first = await phone();
const { page } = first;
await sends(page);

await page.evaluate(() => window.turn(true));
await says(page, /^Turn the phone back/);
await sleep(1500);
await page.evaluate(() => window.turn(false));
await says(page, /^This phone is camera/);
await sends(page);

line.dead = true; // nothing is closed, and nothing comes through
await says(page, /line to Marey is lost/);
line.dead = false;
await says(page, /^This phone is camera/);
await sends(page);

line.cut();
await says(page, /line to Marey is lost/);
await says(page, /^This phone is camera/);
await sends(page);

const hide = (hidden) =>
  page.evaluate((hidden) => {
    Object.defineProperty(document, "hidden", { value: hidden, configurable: true });
    document.dispatchEvent(new Event("visibilitychange"));
  }, hidden);
await hide(true);
await sleep(2500);
await hide(false);
await sends(page);

const control = await page.context().newCDPSession(page);
await control.send("Page.setWebLifecycleState", { state: "frozen" });
await sleep(8000);
await control.send("Page.setWebLifecycleState", { state: "active" });
await says(page, /^This phone is camera/);
await sends(page);

const second = await phone();
await says(page, /^Another phone is this camera now/);
await sends(second.page);
await sleep(1000);
const taken = [];
for (const { page, wrong, first: begun } of [first, second])
  taken.push({ wrong, images: (await page.evaluate(() => sequence)) - begun, omitted: await page.evaluate(() => omitted), problem: await page.textContent("#problem") });
console.log(JSON.stringify(taken));
await browser.close();
line.end();
