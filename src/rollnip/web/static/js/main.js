// The page put together: state, inputs, answers, tabs, menus.

import { get, onOutage } from "./api.js";
import { App } from "./app.js";
import { byId, el } from "./dom.js";
import { alarm, clearAlarm } from "./answers.js";
import { remember } from "./saved.js";
import { LANGUAGE, fillPage, say, translated } from "./texts.js";

const PICKED = ".toml,.json,application/toml,application/json,text/plain";

async function start() {
  fillPage();
  document.title = say("app.page");
  byId("language").addEventListener("click", () => {
    remember("language", LANGUAGE === "de" ? "en" : "de");
    location.reload();
  });
  onOutage((yes) => (yes ? alarm(say("outage.title"), [say("outage.text")]) : clearAlarm()));
  const [units, materials, hardness, examples] = await Promise.all([
    get("/api/units"),
    get("/api/materials"),
    get("/api/hardness"),
    get("/api/examples"),
  ]);
  const app = new App({
    units,
    materials: materials.map((one) => translated("library", one)),
    hardness,
    examples: examples.map((one) => translated("example", one)),
  });
  const file = el("input", {
    type: "file",
    id: "file",
    accept: PICKED,
    hidden: true,
    "aria-label": say("file.case"),
  });
  file.addEventListener("change", () => {
    if (file.files[0]) app.loadFile(file.files[0]);
    file.value = "";
  });
  document.body.append(file);
  await app.begin(location.hash);
  document.documentElement.dataset.ready = "yes";
}

start().catch((error) => {
  byId("big").textContent = "–";
  alarm(say("start.failed"), [error.message]);
});
