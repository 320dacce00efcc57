import pytest

from rollnip._errors import RollnipError
from rollnip.plots import new_axes, plot_pressure, save_figure


@pytest.mark.parametrize(
    ("name", "start"), [("a.png", b"\x89PNG"), ("a.svg", b"<?xml"), ("a.PDF", b"%PDF")]
)
def test_saves(solution, tmp_path, name, start):
    path = tmp_path / name
    save_figure(plot_pressure(solution).figure, path)
    assert path.read_bytes().startswith(start)
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize(("name", "hint"), [("a.exe", r"must end in \.png"), ("b/a.png", "no dir")])
def test_what_cannot_be_written_is_one_line(tmp_path, name, hint):
    with pytest.raises(RollnipError, match=hint):
        save_figure(new_axes().figure, tmp_path / name)
