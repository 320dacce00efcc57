"""Keyboard, screen reader, dark colours, a phone: axe finds nothing, nothing overflows."""

import pytest
from axe_playwright_python.sync_playwright import Axe
from tests.browser.conftest import DEFAULT, Designer, Watch, fragment, new_context

pytestmark = pytest.mark.slow

WINDOWS = {
    "desk": {},
    "phone": {"viewport": {"width": 360, "height": 740}, "has_touch": True},
}
THEMES = ("light", "dark")
TABS = ("pressure", "inside", "whatif", "find", "compare")


@pytest.fixture(params=WINDOWS)
def seen(request, browser, base):
    context = new_context(browser, **WINDOWS[request.param])
    page = context.new_page()
    watch = Watch(page, base)
    yield Designer(page, base).open()
    watch.check()
    context.close()


def violations(page, part=None):
    """What axe finds in a part of the page; in dark colours only of the contrast."""
    is_dark = page.evaluate("document.documentElement.dataset.theme") == "dark"
    options = {"runOnly": ["color-contrast"]} if is_dark else None
    found = Axe().run(page, context=part, options=options).response["violations"]
    return [(one["id"], [node["html"][:120] for node in one["nodes"][:3]]) for one in found]


def overhang(page):
    """Pixels that the page is wider than its window."""
    root = "document.documentElement"
    return page.evaluate(f"{root}.scrollWidth - {root}.clientWidth")


def repaint(designer, theme):
    """Choose the colours of the page."""
    page = designer.page
    if page.evaluate("document.documentElement.dataset.theme") != theme:
        page.click("#theme")
        page.wait_for_selector(f'html[data-theme="{theme}"]')
        designer.quiet()


def test_axe_finds_nothing_and_nothing_is_too_wide_in_any_view(seen):
    """In both colours on one page: what is computed once is looked at twice."""
    page = seen.page
    page.select_option("#in-upper-layers-0-material-kind", "prony")
    page.evaluate("document.querySelectorAll('details').forEach(fold => { fold.open = true; })")
    seen.quiet()
    for theme in THEMES:
        seen.enter("in-nip-load", {"light": "2", "dark": "3"}[theme])
        seen.tab("pressure")
        repaint(seen, theme)
        assert violations(page) == []
        assert overhang(page) <= 0
        for tab in TABS[1:]:
            seen.tab(tab)
            seen.quiet()
            assert violations(page, "#panel") == [], tab
            assert overhang(page) <= 0, tab
        if theme == "light":
            page.click("#keep")
            page.wait_for_selector("#kept-drop-0")
            seen.quiet()
            assert violations(page, "#panel") == []
        for opener, part in (
            ("#open-share", "#open-share-menu"),
            ("#open-designs", "#open-designs-menu"),
            ("#open-examples", "#examples"),
        ):
            page.click(opener)
            assert violations(page, part) == [], opener
            page.keyboard.press("Escape")
        seen.type("in-nip-load", "nothing")
        assert page.get_attribute("#in-nip-load", "aria-invalid") == "true"
        assert violations(page) == []


def test_axe_finds_nothing_along_the_face(seen):
    page = seen.page
    seen.tab("face")
    assert violations(page, "#panel") == []
    page.click("#give-face")
    seen.rest("face")
    page.evaluate("document.querySelectorAll('details').forEach(fold => { fold.open = true; })")
    page.check("#in-upper-weighs")
    seen.rest("face")
    page.click("#crown-go")
    page.wait_for_selector("#crown-use")
    seen.quiet()
    for theme in THEMES:
        repaint(seen, theme)
        assert violations(page) == []
        assert overhang(page) <= 0


def test_the_answer_stays_in_sight_on_a_phone(browser, base):
    context = new_context(browser, **WINDOWS["phone"])
    designer = Designer(context.new_page(), base).open()
    page = designer.page
    assert page.locator("#big").bounding_box()["y"] < 300
    page.locator("#in-nip-load").scroll_into_view_if_needed()
    page.wait_for_selector("#mini.shown")
    assert "Nip" in page.inner_text("#mini")
    for control in ("#undo", "#open-share", "#theme", "#us"):
        box = page.locator(control).bounding_box()
        assert box["x"] >= 0
        assert box["x"] + box["width"] <= 360
    context.close()


def test_the_theme_follows_the_system_until_it_is_chosen(browser, base):
    context = new_context(browser, color_scheme="dark")
    designer = Designer(context.new_page(), base).open()
    page = designer.page
    ground = "getComputedStyle(document.body).backgroundColor"
    chart = "document.getElementById('chart-pressure').layout?.paper_bgcolor"
    designer.until(f"{chart} === '#171c22'")
    assert page.evaluate(ground) == "rgb(15, 19, 23)"
    page.click("#theme")
    designer.until(f"{chart} === '#ffffff'")
    assert page.evaluate(ground) == "rgb(243, 245, 248)"
    page.reload()
    page.wait_for_selector('html[data-theme="light"]')
    context.close()


def test_everything_is_reached_by_keyboard(designer):
    page = designer.page
    page.evaluate("document.activeElement.blur(); window.scrollTo(0, 0)")
    page.keyboard.press("Tab")
    reached = []
    for _turn in range(60):
        reached.append(page.evaluate("document.activeElement.id || document.activeElement.tagName"))
        page.keyboard.press("Tab")
    for wanted in (
        "metric",
        "open-examples",
        "open-share",
        "theme",
        "in-upper-radius",
        "in-upper-radius-slider",
        "in-upper-layers-0-material-kind",
        "add-upper",
        "in-press-load",
        "in-drive",
        "tab-pressure",
        "panel",
    ):
        assert wanted in reached, wanted
    page.focus("#tab-pressure")
    page.keyboard.press("ArrowRight")
    assert page.evaluate("document.activeElement.id") == "tab-gap"
    page.keyboard.press("End")
    assert page.get_attribute("#tab-compare", "aria-selected") == "true"
    page.focus("#open-share")
    page.keyboard.press("Enter")
    assert page.evaluate("document.activeElement.id") == "copy-link"
    page.keyboard.press("Escape")
    assert page.evaluate("document.activeElement.id") == "open-share"


def test_the_focus_survives_a_new_panel(designer):
    page = designer.page
    page.focus("#in-drive")
    page.select_option("#in-drive", "creepage")
    assert page.evaluate("document.activeElement.id") == "in-drive"
    page.click("#add-upper")
    designer.rest()
    assert page.evaluate("document.activeElement.id") == "add-upper"
    page.click("#remove-upper-1")
    assert page.evaluate("document.activeElement.id") == "add-upper"


@pytest.mark.parametrize("width", [375, 760, 1280])
def test_every_tab_can_be_seen_and_the_open_one_is(browser, base, width):
    """In rows where there is room; on a phone the bar scrolls to the tab that is open."""
    context = new_context(browser, viewport={"width": width, "height": 800}, locale="de-DE")
    page = Designer(context.new_page(), base).open(fragment({"case": DEFAULT, "tab": "find"})).page
    inside = """id => { const bar = document.getElementById('tabs').getBoundingClientRect();
      const box = document.getElementById(id).getBoundingClientRect();
      return box.left >= bar.left - 1 && box.right <= bar.right + 1; }"""
    assert page.evaluate(inside, "tab-find")
    names = page.locator("#tabs button").evaluate_all("all => all.map(one => one.id)")
    if width > 700:
        assert all(page.evaluate(inside, name) for name in names)
    assert overhang(page) <= 0
    context.close()


def test_on_a_phone_the_alarm_stands_clear_of_the_header(browser, base):
    context = new_context(browser, viewport={"width": 375, "height": 740})
    designer = Designer(context.new_page(), base).open()
    page = designer.page
    designer.enter("in-upper-layers-0-thickness", "120 mm")
    page.wait_for_selector("#alarm .alarm")
    page.evaluate("scrollTo(0, 1500)")
    designer.until("scrollY > 0")
    seen = page.evaluate(
        """() => { const box = document.querySelector('#alarm b').getBoundingClientRect();
        const top = document.elementFromPoint(box.left + 4, box.top + 4);
        return Boolean(top?.closest('#alarm')); }"""
    )
    assert seen
    context.close()


def test_on_a_phone_the_stresses_on_bonds_are_read_without_scrolling(browser, base):
    """Half of the largest pull, and the end of the heading, lay outside."""
    foam = {"model": "elastic", "modulus": 0.05, "poisson": 0.1}
    roller = {"radius": 8, "layers": [{"thickness": 4, "material": foam}]}
    nip = {"load": 0.05, "friction": 0.5, "speed": 1000}
    case = {"title": "", "nip": nip, "upper": roller, "lower": roller}
    context = new_context(browser, viewport={"width": 390, "height": 844})
    page = context.new_page()
    designer = Designer(page, base).open(fragment({"case": case}))
    designer.tab("inside")
    page.wait_for_selector("#bonds")
    beyond = page.locator("#bonds").evaluate(
        "table => table.parentElement.scrollWidth - table.parentElement.clientWidth"
    )
    assert beyond == 0
    context.close()
