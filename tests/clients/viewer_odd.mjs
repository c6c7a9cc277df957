// Browsers that lack something, and pages that are opened twice or again. viewer_odd.mjs PAGE_FOLDER FOLDER SCENARIO ADDRESS, as
// viewer_page.mjs.
import assert from "node:assert/strict";
import { join } from "node:path";
import { browse } from "./viewer_browser.mjs";

const [, , page_folder, folder, scenario, address] = process.argv;

/** A page in which `before` ran first; it is opened, and its list waited for. */
async function opened(before) {
  const browsed = await browse(page_folder, false);
  if (before) await browsed.page.addInitScript(before);
  await browsed.page.goto(address);
  await browsed.eventually("the list is empty", async () => parseInt(await browsed.text("#count")) > 3);
  return browsed;
}
const time = (page) => page.evaluate(() => Number(document.body.dataset.time));

async function without_webgl() {
  const { page, text, eventually, done } = await opened(() => {
    const get = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
      return /webgl/.test(kind) ? null : get.call(this, kind, ...rest);
    };
  });
  assert.match(await text("#view"), /draws nothing in space, for it has no WebGL: switch hardware acceleration on .* list and the plots work/);
  await page.locator(".row .name").first().click();
  await page.click('#tabs [data-tab="plot"]');
  await eventually("nothing is plotted", async () => (await page.locator(".uplot canvas").count()) > 0);
  await page.click("#play");
  await eventually("it does not play", async () => (await time(page)) > 0.2);
  await page.screenshot({ path: join(folder, `${scenario}_no_webgl.png`) });
  await done("without WebGL", (line) => /WebGL/.test(line));
}

async function without_sockets() {
  const none = await opened(() => delete globalThis.WebSocket);
  await none.eventually("it is not said", async () => /This browser has no WebSockets; the recording is shown/.test(await none.text("#said")));
  await none.page.click("#play");
  await none.eventually("it does not play", async () => (await time(none.page)) > 0.2);
  await none.page.screenshot({ path: join(folder, `${scenario}_no_socket.png`) });
  await none.done("without WebSockets");
  const blocked = await opened(() => {
    globalThis.WebSocket = class {
      constructor() {
        setTimeout(() => this.onclose(), 20);
      }
    };
  });
  await blocked.eventually("it is not said", async () => /cannot be heard: a proxy or an extension .* the recording is shown/.test(await blocked.text("#said")));
  await blocked.done("with WebSockets that are blocked");
}

async function twice_and_again() {
  const first = await opened();
  const second = await first.page.context().newPage();
  await second.goto(address);
  const again = async (page) => {
    await page.reload();
    await first.eventually("after it was loaded again the list is empty", async () => parseInt(await page.textContent("#count")) > 3);
    await page.click("#play");
    await first.eventually("after it was loaded again it does not play", async () => (await time(page)) > 0.2);
    assert.equal(await page.locator("#said").isVisible(), false);
  };
  await second.click("#play");
  await first.eventually("the second page does not play", async () => (await time(second)) > 0.2);
  await again(second); // while it plays
  await again(first.page);
  assert.equal(new URL(first.page.url()).search, "", "the token stands in the address bar");
  await second.close();
  await first.done("opened twice, and loaded again");
}

await without_webgl();
await without_sockets();
await twice_and_again();
console.log(`${scenario}: done`);
