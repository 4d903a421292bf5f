"""sim.backends.native_build: each text is compiled once, by several processes too, and failures are explained."""

import ctypes
import multiprocessing

import pytest

from golden.support.errors import InputError
from sim.backends.native_build import library

PROGRAM = '#include "number.inc"\nextern "C" int number() { return NUMBER; }\n'
FILES = {"main.cpp": PROGRAM, "number.inc": "#define NUMBER 7\n"}


def number(path):
    return ctypes.CDLL(str(path)).number()


def test_a_program_is_compiled_once(tmp_path):
    built = library(FILES, "main.cpp", tmp_path)
    assert number(built) == 7
    stamp = built.stat().st_mtime_ns
    assert library(FILES, "main.cpp", tmp_path) == built
    assert built.stat().st_mtime_ns == stamp
    assert list(tmp_path.iterdir()) == [built]


def test_another_text_is_another_program(tmp_path):
    built = [library(FILES | {"number.inc": f"#define NUMBER {n}\n"}, "main.cpp", tmp_path) for n in (1, 2)]
    assert [number(path) for path in built] == [1, 2]


def test_processes_that_compile_the_same_program_at_the_same_time_all_get_it(tmp_path):
    with multiprocessing.get_context("fork").Pool(4) as pool:
        built = pool.starmap(library, [(FILES, "main.cpp", tmp_path)] * 8)
    assert len(set(built)) == 1
    assert number(built[0]) == 7
    assert list(tmp_path.iterdir()) == [built[0]]


def test_a_missing_compiler_is_named(tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(InputError, match=r"^the integer model needs a C\+\+ compiler \(c\+\+\): install one"):
        library(FILES, "main.cpp", tmp_path)


def test_the_compilers_message_is_kept(tmp_path):
    with pytest.raises(RuntimeError, match=r"(?s)refuses main.cpp:.*NUMBER"):
        library(FILES | {"number.inc": ""}, "main.cpp", tmp_path)
    assert not list(tmp_path.iterdir())
