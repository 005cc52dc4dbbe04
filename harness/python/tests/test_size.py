"""What the wheel weighs, and the list of what weighs most: whose a function is."""

import sys

import pytest
from conftest import ROOT

sys.path.insert(0, str(ROOT / "harness/python/benches"))
import size


def test_a_function_is_of_the_crate_that_it_is_written_in():
    for name, crate in [
        ("calibench_measure::harris::kernel::single::single_avx2_version", "calibench_measure"),
        ("<toml::de::Value as serde_core::de::Deserializer>::deserialize_struct", "toml"),
        ("<&mut serde_json::de::Deserializer<R> as serde_core::de::Deserializer>::deserialize_seq", "serde_json"),
        ("<[alloc::string::String] as core::fmt::Debug>::fmt", "alloc"),
        ("core::ptr::drop_in_place<calibench_model::camera::Camera>", "core"),
        ("<dyn core::any::Any>::is", "core"),
        ("memcpy", "C, and what has no name"),
    ]:
        assert size.crate(name) == crate, name


def test_what_is_compiled_more_than_once_is_one_function():
    names = ["a::one::one_avx2_version", "a::one::one_default_version", "a::one::one_avx512bw_avx512cd_version", "a::one::h0123456789abcdef", "a::one.llvm.77"]
    assert {size.function(name) for name in names} == {"a::one"}


def test_what_repeats_weighs_little():
    assert size.packed(b"ab" * 5000) < 100 < size.packed(bytes(range(256)))


def test_the_wheel_has_less_than_ten_megabytes():
    wheels = sorted((ROOT / "target/wheels").glob("calibench-*.whl"), key=lambda wheel: wheel.stat().st_mtime)
    if not wheels:
        pytest.skip("no wheel in target/wheels: `just python` builds it")
    weight = wheels[-1].stat().st_size
    assert weight < 10_000_000, f"{wheels[-1].name} has {weight / 1e6:.2f} MB; expected less than 10: `just size-python` lists what weighs most"
