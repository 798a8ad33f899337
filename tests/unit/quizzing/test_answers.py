"""Answers from a file: what is accepted, and what is said about what is not."""

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from course.errors import UsageError
from course.quizzing.answers import read_answers

SEED = 2026  # sums: next, none, total, less; colours: grey, black, white, dark (snow)


def written(folder, text, name="answers.toml"):
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def choose(path, bank, seed=SEED):
    return read_answers(path).choose(bank.pose(seed), bank, seed)


def refused(path, bank, seed=SEED):
    with pytest.raises(UsageError) as caught:
        choose(path, bank, seed)
    assert str(path) in caught.value.message
    assert caught.value.help
    return caught.value


@pytest.mark.parametrize("answer", ['"total"', '"c"', '"C"', '"3"', "3"])
def test_an_answer_is_an_id_a_letter_or_a_number(tmp_path, bank, answer):
    path = written(tmp_path, f'seed = {SEED}\n[answers]\nsums = {answer}\ncolours = "white"\n')
    assert choose(path, bank) == {"sums": "total", "colours": "white"}
    assert read_answers(path).seed == SEED


def test_json_of_the_same_shape_will_do(tmp_path, bank):
    text = json.dumps({"format_version": 1, "seed": SEED, "answers": {"colours": "c", "sums": "total"}})
    assert choose(written(tmp_path, "\ufeff" + text, "a.json"), bank) == {"sums": "total", "colours": "white"}


@pytest.mark.parametrize(
    ("text", "line", "code", "said"),
    [
        ("[answers]\nsums = ", 2, "answers_format", "not valid TOML"),
        ("answers = 3", None, "answers_format", "no table of answers"),
        ("seed = 1", None, "answers_format", "no table of answers"),
        ('sums = "a"\n', None, "answers_format", "unknown key 'sums'"),
        ('\nseed = "x"\n[answers]\n', 2, "answers_format", "not a whole number"),
        ("format_version = 2\n[answers]\n", 1, "answers_format", "format_version is 2"),
        ('seed = 7\n[answers]\nsums = "a"', 1, "answers_for_other_seed", "for seed 7"),
        ('[answers]\nsums = "a"\nsum = "b"\n', 3, "question_not_found", "no question 'sum'"),
        ('\n[answers]\nsums = "a"\n', 2, "answers_missing", "1 answer is missing: colours"),
        ("[answers]\n", 1, "answers_missing", "2 answers are missing: sums, colours"),
        ('[answers]\nsums = "a"\ncolours = ""\n', 1, "answers_missing", "1 answer is missing: colours"),
        ('[answers]\nsums = "a"\ncolours = "e"\n', 3, "option_not_found", "colours has no option 'e'"),
        ('[answers]\ncolours = "a"\nsums = true\n', 3, "answer_not_text", "the answer to sums is not text"),
        (
            '[answers]\nsums = "two-fruits"\ncolours = "a"',
            2,
            "answers_for_other_seed",
            "as another seed asks",
        ),
    ],
)
def test_a_mistake_is_named_with_its_line(tmp_path, bank, text, line, code, said):
    path = written(tmp_path, text)
    error = refused(path, bank)
    assert said in error.message
    assert error.code == code
    assert error.message.startswith(f"{path}:{line}: " if line else f"{path}: ")


def test_a_near_miss_is_recognised(tmp_path, bank):
    assert refused(written(tmp_path, '[answers]\nsum = "a"'), bank).help == "Did you mean sums?"


def test_a_mistake_in_json_is_named_with_its_line(tmp_path, bank):
    text = '{\n "answers": {\n  "sums": "a",\n  "colours": "e"\n }\n}'
    assert refused(written(tmp_path, text, "a.json"), bank).message.startswith(f"{tmp_path / 'a.json'}:4: ")
    assert ":1: " in refused(written(tmp_path, "[1]", "b.json"), bank).message
    assert ":2: " in refused(written(tmp_path, "{\n x", "c.json"), bank).message
    twice = written(tmp_path, '{"answers": {"sums": "a", "sums": "b"}}', "d.json")
    assert "'sums' is there twice" in refused(twice, bank).message
    deep = written(tmp_path, "[" * 100_000, "e.json")
    assert "JSON" in refused(deep, bank).message
    for number, text in enumerate(("{", "[]", "{}", '{"answer": {}}', '{"answers": {"sums": "a"}}')):
        advice = refused(written(tmp_path, text, f"{number}.json"), bank).help
        assert "[answers]" not in advice
        assert '"answers"' in advice


def test_a_question_that_is_not_asked_now_is_named(tmp_path, bank):
    path = written(tmp_path, '[answers]\nsums = "a"\ncolours = "a"\n')
    with pytest.raises(UsageError, match=r":3: colours is not asked now"):
        read_answers(path).choose(bank.pose(SEED, only=["sums"]), bank, SEED)


def test_a_file_that_cannot_be_read_says_why(tmp_path, bank):
    assert refused(tmp_path / "none.toml", bank).code == "answers_unreadable"
    assert refused(tmp_path, bank).code == "answers_unreadable"
    (tmp_path / "latin.toml").write_bytes(b"# x\nx = '\xe9'")
    assert ":2: this is not UTF-8" in refused(tmp_path / "latin.toml", bank).message
    (tmp_path / "big.toml").write_bytes(b"#" * 200_000)
    assert refused(tmp_path / "big.toml", bank).message.endswith("big.toml is larger than 100,000 bytes.")


@given(
    text=st.text(max_size=60)
    | st.text('{}[]":,=\n ansuwermcolos1_', max_size=80).map(lambda tail: f"seed = 1\n[answers]\n{tail}"),
    suffix=st.sampled_from([".toml", ".json"]),
)
def test_no_file_does_more_than_be_refused(tmp_path_factory, text, suffix):
    path = tmp_path_factory.getbasetemp() / f"answers{suffix}"
    path.write_bytes(text.encode("utf-8", "surrogatepass"))
    try:
        answers = read_answers(path).answers
    except UsageError:
        return
    assert isinstance(answers, dict)
