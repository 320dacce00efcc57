// What the page has begun and not finished, counted in attributes of the root: 0 where nothing is.

const ROOT = document.documentElement;

/** Texts being read, designs being opened, questions to the server, charts being drawn, timers. */
const KINDS = ["reading", "opening", "asking", "drawing", "waiting"];

for (const kind of KINDS) ROOT.dataset[kind] = "0";

function add(kind, change) {
  ROOT.dataset[kind] = String(Number(ROOT.dataset[kind]) + change);
}

/** Count a promise until it has ended and what follows from it at once has begun; return it. */
export function underway(kind, work) {
  add(kind, 1);
  const end = () => setTimeout(() => add(kind, -1));
  work.then(end, end);
  return work;
}

/** Do something after a time [ms]; return what gives it up. */
export function later(act, time) {
  let isOver = false;
  const end = () => {
    if (!isOver) add("waiting", -1);
    isOver = true;
  };
  const timer = setTimeout(() => {
    act();
    end();
  }, time);
  add("waiting", 1);
  return () => {
    clearTimeout(timer);
    end();
  };
}
