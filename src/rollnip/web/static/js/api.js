// The server's answers; every failure becomes one ApiError with a sentence for people.

import { underway } from "./busy.js";
import { placeInWords } from "./paths.js";
import { inLanguage } from "./sentences.js";
import { say } from "./texts.js";

/** What went wrong, with the places in the case it belongs to. */
export class ApiError extends Error {
  constructor(message, status, details = []) {
    super(known(message));
    this.status = status;
    this.details = details;
  }
}

/** What went wrong, a sentence for each place it belongs to; `place` writes a path. */
export function sentencesOf({ message, details = [] }, place = placeInWords) {
  if (details.length === 0) return [message];
  return details.map((one) => place(one.path) + known(one.message));
}

/** A single complaint without its place: for a box that holds one value. */
export function complaintOf({ message, details = [] }) {
  const text = known(details[0]?.message ?? message);
  return text.charAt(0).toUpperCase() + text.slice(1);
}

/** A sentence of the server in the language of the page, where that has it. */
function known(text) {
  return inLanguage(text) ?? text;
}

/**
 * Where a nip is solved. Stresses on interfaces, which cost more than the rest, are not shown here, and the page asks
 * for face and heat by themselves.
 */
export const SOLVE = "/api/solve?interfaces=false&whole=false";

const RETRIES = 4;
const WAIT = 400; // ms before asking a busy server again
const AGAIN = 1500; // ms before asking one that does not answer

/** GET a path. */
export function get(path) {
  return underway("asking", reach(path, { headers: { Accept: "application/json" } }).then(answer));
}

/** POST a tree; `signal` gives it up. */
export function post(path, tree, signal) {
  return underway("asking", posted(path, tree, signal).then(answer));
}

/** The result of a case, with the hash of the case. */
export function solved(tree, signal) {
  const hashed = async (response) => ({ ...(await answer(response)), hash: response.headers.get("x-rollnip-case") });
  return underway("asking", posted(SOLVE, tree, signal).then(hashed));
}

/** The response to a tree; a busy server (429) is asked again some times. */
async function posted(path, tree, signal) {
  const request = {
    method: "POST",
    body: JSON.stringify(tree),
    headers: { "Content-Type": "application/json" },
    signal,
  };
  for (let turn = 0; ; turn += 1) {
    const response = await reach(path, request);
    if (response.status !== 429 || turn === RETRIES) return response;
    await pause(WAIT * (turn + 1), signal);
  }
}

/** What is told when the server stops answering (true) and when it answers again (false). */
const outage = { tell: () => {}, lasts: false };

/** Call `tell(yes)` when the server stops answering, and when it answers again. */
export function onOutage(tell) {
  outage.tell = tell;
}

/** Ask until the server answers or nobody waits any more. */
async function reach(path, request) {
  for (;;) {
    try {
      const response = await fetch(path, request);
      setOutage(false);
      return response;
    } catch (error) {
      if (error.name === "AbortError") throw error;
      setOutage(true);
    }
    await pause(AGAIN, request.signal);
  }
}

function setOutage(yes) {
  if (outage.lasts === yes) return;
  outage.lasts = yes;
  outage.tell(yes);
}

/** Wait; who gives up throws as a request given up does. */
function pause(time, signal) {
  return new Promise((resolve, reject) => {
    const timer = setTimeout(resolve, time);
    signal?.addEventListener("abort", () => {
      clearTimeout(timer);
      reject(new DOMException("given up", "AbortError"));
    });
  });
}

async function answer(response) {
  const tree = await response.json().catch((error) => {
    if (isAbort(error)) throw error; // given up while the body was read: nothing to complain of
    return null;
  });
  if (response.ok && tree !== null) return tree;
  const said = tree?.error ?? say("server.status", { status: response.status });
  throw new ApiError(said, response.status, tree?.details ?? []);
}

/** Whether an error only says that nobody waits for the answer any more. */
export function isAbort(error) {
  return error.name === "AbortError";
}
