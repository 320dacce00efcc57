from rollnip._html import html_table


def test_every_text_is_escaped():
    found = html_table("a < b", ["<x>"], [["1 & 2"], ["3"]], ["<script>"])
    assert "<b>a &lt; b</b>" in found
    assert "<th>&lt;x&gt;</th>" in found
    assert found.count("<tr>") == 3
    assert "<td>1 &amp; 2</td>" in found
    assert found.endswith("<p>&lt;script&gt;</p>")
