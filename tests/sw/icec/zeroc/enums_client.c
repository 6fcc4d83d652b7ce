/* SPDX-License-Identifier: MIT
 *
 * enums_client: calls the server of ZeroC's suite "enums".
 */
#include "Test.h"
#include "client.h"

#define ECHO(operation, Enum, value)                                               \
    do {                                                                           \
        Test_##Enum out, result;                                                   \
        CHECK(Test_TestIntfPrx_##operation(&prx, value, &out, &result) == ICE_OK); \
        CHECK(out == value && result == value);                                    \
    } while (0)
#define ECHO_ALL(operation, Enum, first, middle, last)                                \
    do {                                                                              \
        Test_##Enum values[3];                                                        \
        Test_##Enum##Seq in, out, result;                                             \
        Ice_Int i;                                                                    \
        values[0] = first, values[1] = middle, values[2] = last;                      \
        in.size = 3, in.data = values;                                                \
        CHECK(Test_TestIntfPrx_##operation##Seq(&prx, &in, &out, &result) == ICE_OK); \
        CHECK(out.size == 3 && result.size == 3);                                     \
        for (i = 0; i < 3; ++i) {                                                     \
            ECHO(operation, Enum, values[i]);                                         \
            CHECK(i < out.size && out.data[i] == values[i]);                          \
        }                                                                             \
    } while (0)

void Suite_call(Ice_CommunicatorPtr ic) {
    Ice_ObjectPrx base = Suite_proxy(ic, "test");
    Test_TestIntfPrx prx;
    CHECK(Test_TestIntfPrx_checkedCast(&prx, &base) == ICE_OK && !Ice_ObjectPrx_isNull(&prx));
    ECHO_ALL(opByte, ByteEnum, Test_benum1, Test_benum7, Test_benum11);
    ECHO_ALL(opShort, ShortEnum, Test_senum1, Test_senum8, Test_senum11);
    ECHO_ALL(opInt, IntEnum, Test_ienum1, Test_ienum11, Test_ienum12);
    ECHO_ALL(opSimple, SimpleEnum, Test_red, Test_green, Test_blue);
    CHECK(Test_TestIntfPrx_shutdown(&prx) == ICE_OK);
}
