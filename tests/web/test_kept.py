"""What is kept: the last things by key, as many as fit."""

import asyncio

from rollnip.web import Limits
from rollnip.web.answers import Reply
from rollnip.web.desk import Desk
from rollnip.web.kept import Kept


def test_what_was_not_asked_for_longest_gives_way():
    kept = Kept(2)
    assert kept.get("a") is None
    for key in "ab":
        assert kept.put(key, key.upper()) == key.upper()
    assert kept.get("a") == "A"
    kept.put("c", "C")
    assert [kept.get(key) for key in "abc"] == ["A", None, "C"]


def test_sizes_add_up_also_where_a_thing_takes_the_place_of_another():
    kept = Kept(10, len)
    kept.put("a", "1234")
    kept.put("b", "123456")
    kept.put("a", "12345")  # 11 together: b, which was asked for longer ago, has to go
    assert kept.get("b") is None
    kept.put("c", "12345")
    assert (kept.get("a"), kept.get("c")) == ("12345", "12345")


def test_what_is_larger_than_all_room_is_not_kept_and_nothing_goes_for_it():
    kept = Kept(5, len)
    kept.put("a", "1234")
    assert kept.put("b", "123456") == "123456"
    assert (kept.get("a"), kept.get("b")) == ("1234", None)


class Counted:
    """A pool that counts what it is asked for, and refuses a friction below zero."""

    def __init__(self):
        self.asked = 0

    async def run(self, task):
        self.asked += 1
        return Reply(422 if task.body["case"]["friction"] < 0 else 200, f"{self.asked}".encode())


def test_a_question_that_comes_again_needs_no_worker():
    """Undo, or a link to a design that was there: the same answer, and nothing is solved."""

    async def asked_by(desk, *cases):
        return [(await desk.solve(case, interfaces=False, whole=False)).body for case in cases]

    desk = Desk(Limits())
    desk.pool = Counted()
    one, other = {"friction": 0.5, "load": 4}, {"friction": 0.5, "load": 5}
    backwards = {"load": 4, "friction": 0.5}
    assert asyncio.run(asked_by(desk, one, other, one, backwards)) == [b"1", b"2", b"1", b"1"]
    wrong = {"friction": -1}
    assert asyncio.run(asked_by(desk, wrong, wrong)) == [b"3", b"4"]
    asyncio.run(desk.task("surfaces", {"case": one}))
    assert desk.pool.asked == 5
