# SPDX-License-Identifier: MIT
"""record_test: tests that a description results in the same layout in Python and in C."""

import os
import subprocess
import tempfile
import unittest

from icesoc.util import record

FIELDS = {"magic": ["char[4]", "a text"], "small": ["u8[4]", "bytes"], "word": ["u32", "a word"],
          "half": ["u16[2]", "halves"], "big": ["u64", "eight bytes"]}


def described(**fields):
    return record.Record({"name": "Sample", "constants": {"SAMPLE_MAGIC": "ABCD", "SAMPLE_TRUE": 7},
                          "fields": fields})


class Record(unittest.TestCase):
    def test_what_is_packed_is_unpacked(self):
        sample = described(**FIELDS)
        values = {"magic": b"ABCD", "small": (1, 2, 3, 4), "word": 5, "half": (6, 7), "big": 8}
        self.assertEqual(sample.unpack(sample.pack(**values)), values)
        self.assertEqual(sample.unpack(sample.pack(**values), "word"), {"word": 5})

    def test_a_c_compiler_agrees_about_each_offset(self):
        sample = described(**FIELDS)
        checks = "".join(
            f"typedef char {name}At[offsetof(Sample, {name}) == {field.offset} ? 1 : -1];\n"
            for name, field in sample.fields.items())
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "sample.c")
            with open(path, "w") as file:
                file.write(sample.header("sample.toml").replace("#pragma once\n", ""))
                file.write("#include <stddef.h>\n" + checks)
            subprocess.run(["cc", "-std=c99", "-fsyntax-only", path], check=True)

    def test_padding_is_refused(self):
        with self.assertRaisesRegex(ValueError, "word: offset 1 is not aligned to its type u32"):
            described(small=["u8", ""], word=["u32", ""])
        with self.assertRaisesRegex(ValueError, "Sample: its size 5 is not a multiple of 4"):
            described(word=["u32", ""], small=["u8", ""])

    def test_a_wrong_type_is_named(self):
        with self.assertRaisesRegex(ValueError, "x: expected a type .*, got 'i32'"):
            described(x=["i32", ""])


if __name__ == "__main__":
    unittest.main()
