"""Numbers as text: nothing is invented where there is none, and zero has no sign."""

from experiments.evaluation.number.number import Number, interval_text, number_text


def test_what_is_not_known_is_blank() -> None:
    assert (Number(None).text(), Number(None).interval(), interval_text(1.0, None)) == ("-", "", "")
    assert (Number(1.005, 1.0, 2.0).text(1), Number(1.5, 1.0, 2.0).interval()) == ("1.0", "[1.00, 2.00]")


def test_a_small_number_with_a_unit_gets_a_digit_more() -> None:
    assert Number(0.5, 0.4, 0.6, unit="N m").texts() == ("0.500", "[0.400, 0.600]")
    assert [Number(0.5).texts()[0], Number(1.5, unit="N m").texts()[0]] == ["0.50", "1.50"]


def test_what_rounds_to_zero_has_no_sign() -> None:
    assert [number_text(-0.004), number_text(-0.3, 0), number_text(-0.006)] == ["0.00", "0", "-0.01"]
    assert interval_text(-0.4, 0.4, 0) == "[0, 0]"
