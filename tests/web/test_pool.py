"""The queue before the workers: order, what is dropped, what is refused, what is replaced.

The event loop has a clock of its own: it goes on to the next timer where nothing else is to be
done, so that no time passes and no machine is too slow or too fast.
"""

import asyncio
import json
import selectors
from collections import deque
from typing import ClassVar

import pytest

from rollnip.web import Limits, pool
from rollnip.web.answers import Reply
from rollnip.web.pool import OverloadedError, Pool, TimeLimitError, WorkerError, WorkerTask


class Fake:
    """A worker that answers a task {"case": name, "seconds": time} after that time."""

    made = 0
    failures = 0
    asked: ClassVar[list] = []

    def __init__(self):
        self.recent = deque(maxlen=4)
        self.stopped = False

    @classmethod
    async def start(cls, limits):
        if cls.failures:
            cls.failures -= 1
            await asyncio.sleep(0.02)  # so that somebody waits by then
            raise WorkerError
        cls.made += 1
        return cls()

    async def ask(self, task):
        body = json.loads(task)["body"]
        Fake.asked.append((self, body["case"]))
        if body["case"] == "crash":
            raise WorkerError
        await asyncio.sleep(body.get("seconds", 0.0))
        return Reply(200, body["case"].encode())

    async def stop(self):
        self.kill()

    def kill(self):
        self.stopped = True


@pytest.fixture(autouse=True)
def _fakes(monkeypatch):
    monkeypatch.setattr(pool, "_Worker", Fake)
    monkeypatch.setattr(pool, "_PAUSE", 0.01)
    Fake.made, Fake.failures, Fake.asked = 0, 0, []


class Leap(selectors.DefaultSelector):
    """Goes on to the next timer at once where no event is there; waits only where there is none."""

    now = 0.0

    def select(self, timeout=None):
        found = super().select(None if timeout is None else 0)
        if not found and timeout:
            self.now += timeout
        return found


class Loop(asyncio.SelectorEventLoop):
    """An event loop with the clock of its selector."""

    def __init__(self):
        self.leap = Leap()
        super().__init__(self.leap)

    def time(self):
        return self.leap.now


def with_pool(scenario, **limits):
    """Run a coroutine with a started pool, and see that nothing is left over."""

    async def whole():
        one = Pool(Limits(**{"workers": 1, **limits}))
        one.start()
        await asyncio.sleep(0.01)
        try:
            async with asyncio.timeout(5.0):
                return await scenario(one)
        finally:
            await one.stop()
            assert not one._jobs

    with asyncio.Runner(loop_factory=Loop) as runner:
        return runner.run(whole())


def ask(one, case, seconds=0.0, limit=1.0, **how):
    return asyncio.create_task(
        one.run(
            WorkerTask(name="solve", body={"case": case, "seconds": seconds}, seconds=limit, **how)
        )
    )


def names():
    return [case for _, case in Fake.asked]


def test_tasks_are_begun_in_the_order_they_came():
    async def scenario(one):
        replies = await asyncio.gather(*(ask(one, name, 0.001) for name in "abcde"))
        assert [reply.body for reply in replies] == [b"a", b"b", b"c", b"d", b"e"]
        assert names() == list("abcde")

    with_pool(scenario)


def test_what_waits_and_is_given_up_is_never_begun():
    async def scenario(one):
        first, stale, last = ask(one, "a", 0.05), ask(one, "b"), ask(one, "c")
        await asyncio.sleep(0.01)
        stale.cancel()
        await asyncio.gather(first, last)
        assert stale.cancelled()
        assert names() == ["a", "c"]

    with_pool(scenario)


def test_a_burst_of_forty_moves_solves_the_first_and_the_last():
    async def scenario(one):
        moves = [ask(one, "0", 0.03)]
        for number in range(1, 40):
            await asyncio.sleep(0)
            moves.append(ask(one, str(number)))
            if number > 1:
                moves[-2].cancel()
        await moves[-1]
        assert names() == ["0", "39"]

    with_pool(scenario)


def test_what_is_given_up_while_it_is_solved_leaves_the_worker_to_the_next():
    async def scenario(one):
        gone = ask(one, "a", 0.03)
        await asyncio.sleep(0.01)
        gone.cancel()
        assert (await ask(one, "b")).body == b"b"
        assert names() == ["a", "b"]
        assert Fake.made == 1

    with_pool(scenario)


def test_a_worker_handed_to_one_who_has_just_left_goes_to_the_next():
    async def scenario(one):
        first, second, third = ask(one, "a", 0.01), ask(one, "b"), ask(one, "c")
        first.add_done_callback(lambda _: second.cancel())
        assert (await third).body == b"c"
        await first
        assert (await ask(one, "d")).body == b"d"

    with_pool(scenario)


def test_more_than_may_wait_are_refused_at_once_but_the_patient():
    async def scenario(one):
        tasks = [ask(one, name, 0.02) for name in "abc"]  # one is solved, two wait
        await asyncio.sleep(0.005)
        with pytest.raises(OverloadedError):
            await ask(one, "d")
        patient = ask(one, "e", patient=True)
        await asyncio.gather(*tasks, patient)
        assert names() == ["a", "b", "c", "e"]

    with_pool(scenario, waiting=2)


def test_nobody_waits_without_end():
    async def scenario(one):
        first = ask(one, "a", 0.1)
        await asyncio.sleep(0)
        with pytest.raises(OverloadedError):
            await ask(one, "b")
        await first
        assert names() == ["a"]

    with_pool(scenario, waiting_seconds=0.02)


def test_a_task_beyond_its_time_ends_and_its_worker_is_replaced():
    async def scenario(one):
        with pytest.raises(TimeLimitError):
            await ask(one, "slow", 3.0, limit=0.02)
        assert (await ask(one, "b")).body == b"b"
        slow, fresh = (worker for worker, _ in Fake.asked)
        assert slow.stopped
        assert fresh is not slow
        assert Fake.made == 2

    with_pool(scenario)


def test_a_worker_that_ends_by_itself_is_replaced():
    async def scenario(one):
        with pytest.raises(WorkerError):
            await ask(one, "crash")
        assert (await ask(one, "b")).body == b"b"

    with_pool(scenario)


def test_the_worker_that_knows_a_case_is_asked_again():
    async def scenario(one):
        await asyncio.gather(ask(one, "a", 0.01), ask(one, "b", 0.01))
        for name in "abbaab":
            await ask(one, name)
        knew = {name: {id(worker) for worker, case in Fake.asked if case == name} for name in "ab"}
        assert len(knew["a"]) == len(knew["b"]) == 1
        assert knew["a"] != knew["b"]

    with_pool(scenario, workers=2)


def test_a_worker_that_does_not_start_is_tried_again():
    async def scenario(one):
        Fake.failures = 1
        with pytest.raises(WorkerError):
            await ask(one, "crash")
        with pytest.raises(WorkerError):  # nobody is there to do it
            await ask(one, "a")
        assert (await ask(one, "b")).body == b"b"
        assert Fake.failures == 0

    with_pool(scenario)
