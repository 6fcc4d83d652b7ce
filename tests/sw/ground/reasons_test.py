# SPDX-License-Identifier: MIT
"""reasons_test: reasons.py gives a short text, with a remedy if there is one, for errors of the
system and of Ice."""
import errno
import unittest

import Ice

from mission_log import whole
from reasons import reason_of


def failed(number):
    error = Ice.ConnectFailedException()
    error.error = number
    return error


class Reasons(unittest.TestCase):
    def test_a_lost_modem_has_a_remedy(self):
        self.assertEqual(reason_of(failed(errno.ENOLINK), ""),
                         "the modem is lost or does not answer: check its cable and its power")

    def test_other_errors_have_the_system_s_text(self):
        self.assertEqual(reason_of(failed(errno.ECONNREFUSED)),
                         "cannot connect: Connection refused")
        self.assertEqual(reason_of(OSError(errno.ENOENT, "No such file or directory", "a.key")),
                         "a.key: No such file or directory")

    def test_an_exception_without_text_is_named_in_words(self):
        self.assertEqual(reason_of(Ice.ConnectTimeoutException()), "Connect timeout")

    def test_an_exception_of_the_vehicle_is_not_mistaken_for_one_of_the_ground(self):
        self.assertEqual(reason_of(Ice.UnknownException("::Ice::TimeoutException")),
                         "the servant reported ::Ice::TimeoutException")

    def test_a_failed_write_names_its_file(self):
        with self.assertRaises(OSError) as caught, whole("/dev/none/report.md"), \
                open("/dev/full", "w") as file:
            file.write("text")
        self.assertEqual(reason_of(caught.exception),
                         "/dev/none/report.md: No space left on device")


if __name__ == "__main__":
    unittest.main()
