"""Up to four designs over each other and side by side."""

import pytest
from tests.browser.conftest import DEFAULT, Designer, fragment, new_context

pytestmark = pytest.mark.slow


def keep(designer, number):
    designer.tab("compare")
    designer.page.click("#keep")
    designer.page.wait_for_selector(f"#kept-drop-{number}")


def test_four_designs_are_overlaid_and_their_differences_shown(designer):
    page = designer.page
    width = designer.nip_width
    for number, load in enumerate(("8", "12", "16")):
        keep(designer, number)
        designer.enter("in-nip-load", load)
    designer.until("document.querySelectorAll('.compare thead th').length === 5")
    designer.until("document.getElementById('chart-compare').data?.length === 4")
    assert page.is_disabled("#keep")
    row = page.locator(".compare tbody tr", has_text="Nip width").inner_text()
    # Half of the last digit of both figures, and of the per cent, as they are shown.
    ratio = designer.nip_width / width
    rounding = 100.0 * ratio * 0.005 * (1.0 / designer.nip_width + 1.0 / width) + 0.05
    percent = 100.0 * (ratio - 1.0)
    shown = float(row.split("+")[-1].split("%")[0])
    assert shown == pytest.approx(percent, abs=rounding)
    page.select_option("#compare-profile", "gap")
    designer.until(
        "document.getElementById('chart-compare').layout.yaxis.title.text.startsWith('Gap')"
    )


def test_a_kept_design_is_opened_and_removed_and_both_can_be_undone(designer):
    page = designer.page
    width = designer.nip_width
    keep(designer, 0)
    designer.enter("in-nip-load", "9")
    designer.click("#kept-open-0")
    assert designer.nip_width == width
    page.click("#kept-drop-0")
    page.wait_for_selector(".compare", state="hidden")
    page.click("#undo")
    page.wait_for_selector("#kept-drop-0")


def test_a_heading_says_in_full_which_design_is_the_one_at_hand(designer):
    """Of "Untitled design (at hand)" the end was cut off."""
    keep(designer, 0)
    designer.until("document.querySelectorAll('.compare thead th').length === 3")
    cut = designer.page.locator(".compare thead th span").evaluate_all(
        "all => all.filter(one => one.scrollWidth > one.clientWidth"
        " || one.scrollHeight > one.clientHeight + 1).length"
    )
    assert cut == 0


def test_on_a_phone_names_of_figures_are_words(browser, base):
    """Beside three designs they had a column as wide as two letters."""
    context = new_context(browser, viewport={"width": 390, "height": 844}, locale="de-DE")
    kept = [{**DEFAULT, "title": title} for title in ("one", "two")]
    page = context.new_page()
    Designer(page, base).open(fragment({"case": DEFAULT, "kept": kept, "tab": "compare"}))
    page.wait_for_selector(".compare tbody th")
    widths = page.locator(".compare tbody th").evaluate_all("all => all.map(n => n.clientWidth)")
    assert min(widths) >= 75
    context.close()


def test_a_design_that_did_not_converge_is_marked_in_the_table(designer):
    keep(designer, 0)
    cells = designer.page.locator(".compare tbody tr", has_text="Converged").inner_text()
    assert "yes" in cells
    assert "NO" not in cells


def test_a_kept_design_without_an_answer_keeps_its_column_and_can_be_removed(fresh):
    loads = {"flat": 1e5, "six": 6}
    kept = [
        {**DEFAULT, "title": title, "nip": {**DEFAULT["nip"], "load": load}}
        for title, load in loads.items()
    ]
    fresh.open(fragment({"case": DEFAULT, "kept": kept, "tab": "compare"}))
    fresh.until("document.querySelectorAll('.compare thead th').length === 4")
    heads = fresh.page.locator(".compare thead th span").all_inner_texts()
    assert heads == ["A: flat", "B: six", "C: Untitled design (at hand)"]
    sound = fresh.page.locator(".compare tbody tr", has_text="Converged").inner_text()
    assert sound.split("\t")[1:] == ["no answer", "yes", "yes"]
    fresh.page.click("#kept-drop-0")
    fresh.until("document.querySelectorAll('.compare thead th').length === 3")
    assert "A: six" in fresh.page.inner_text(".compare thead")


def test_designs_kept_without_a_name_have_different_ones(designer):
    keep(designer, 0)
    keep(designer, 1)
    designer.page.click("#kept-drop-0")
    designer.until("document.querySelectorAll('#kept-drop-1').length === 0")
    keep(designer, 1)
    assert designer.page.locator(".compare thead th span").all_inner_texts()[:2] == [
        "A: Design B",
        "B: Design A",
    ]
