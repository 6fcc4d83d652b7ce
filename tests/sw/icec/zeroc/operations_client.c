/* SPDX-License-Identifier: MIT
 *
 * operations_client: calls the server of ZeroC's suite "operations".
 */
#include "Test.h"
#include "client.h"

#define CALL(operation, arguments) CHECK(Test_MyDerivedClassPrx_##operation arguments == ICE_OK)
/* A call with a sequence or dictionary, `v`, twice: so long are what comes out and the result. */
#define TWICE(operation, Type, v, sizeOut, sizeBack)         \
    do {                                                     \
        Test_##Type out, back;                               \
        CALL(operation, (&prx, &v, &v, &out, &back));        \
        CHECK(out.size == sizeOut && back.size == sizeBack); \
    } while (0)
#define SEQUENCE(Type, name, elements) \
    static Test_##Type name = {(Ice_Int)(sizeof elements / sizeof *elements), elements}

static Test_MyDerivedClassPrx prx;

static void scalars(void) {
    const Ice_Long l = {12, -1};
    Ice_Byte y, yBack;
    Ice_Bool b, bBack;
    Ice_Short s;
    Ice_Int i;
    Ice_Long lOut, lBack;
    Ice_Float f;
    Ice_Double d, dBack;
    Ice_String t, tBack;
    Test_MyEnum e, eBack;
    Test_MyClassPrx p, own, nobody;
    Test_Structure in, out, back;
    CALL(opByte, (&prx, 0xFF, 0x0F, &y, &yBack));
    CHECK(y == 0xF0 && yBack == 0xFF);
    CALL(opBool, (&prx, 1, 0, &b, &bBack));
    CHECK(b && !bBack);
    CALL(opShortIntLong, (&prx, -10, 11, l, &s, &i, &lOut, &lBack));
    CHECK(s == -10 && i == 11 && lOut.low == 12 && lBack.high == -1);
    CALL(opFloatDouble, (&prx, 3.25F, 1.1e10, &f, &d, &dBack));
    CHECK(f == 3.25F && d == 1.1e10 && dBack == 1.1e10);
    CALL(opString, (&prx, Ice_String_from("hello"), Ice_String_from("world"), &t, &tBack));
    SAME(t, "world hello");
    SAME(tBack, "hello world");
    CALL(opMyEnum, (&prx, Test_enum2, &e, &eBack));
    CHECK(e == Test_enum2 && eBack == Test_enum3);
    CALL(opMyClass, (&prx, &prx, &p, &nobody, &own));
    CHECK(Suite_alike(&p, &prx) && Test_MyClassPrx_opVoid(&own) == ICE_OK);
    CHECK(Test_MyClassPrx_opVoid(&nobody) == ICE_OBJECT_NOT_EXIST);
    Test_Structure_init(&in);
    in.p = prx, in.e = Test_enum3, in.s.s = Ice_String_from("abc");
    CALL(opStruct, (&prx, &in, &in, &out, &back));
    CHECK(back.e == Test_enum3 && Suite_alike(&back.p, &prx));
    SAME(out.s.s, "a new string");
    SAME(back.s.s, "abc");
}

static void sequences(void) {
    static Ice_Byte bytes[] = {1, 0x11, 0x12, 0x22};
    static Ice_Bool bools[] = {1, 1, 0};
    static Ice_Short shorts[] = {1, 2, 3};
    static Ice_Int ints[1000];
    static Ice_Long longs[] = {{10, 0}, {30, 0}};
    static Ice_Float floats[] = {3.25F, 1.11F};
    static Ice_Double doubles[] = {1.1e10, 2.2e10, 3.3e10};
    static Ice_String strings[2];
    static Test_ByteS byteLists[2];
    static Test_StringS stringLists[3];
    static Test_StringSS deep[2];
    static Test_ByteBoolD_Entry entries[] = {{10, 1}, {100, 0}};
    static Test_ByteBoolD tables[2];
    static Test_ByteByteSD_Entry lists[1];
    static Test_ShortIntD_Entry numbers[] = {{110, -1}, {1100, 123123}};
    static Test_StringStringD_Entry texts[2];
    SEQUENCE(ByteS, bs, bytes);
    SEQUENCE(BoolS, os, bools);
    SEQUENCE(ShortS, hs, shorts);
    SEQUENCE(IntS, is, ints);
    SEQUENCE(LongS, ls, longs);
    SEQUENCE(FloatS, fs, floats);
    SEQUENCE(DoubleS, ds, doubles);
    SEQUENCE(StringS, ss, strings);
    SEQUENCE(ByteSS, bss, byteLists);
    SEQUENCE(StringSS, sss, stringLists);
    SEQUENCE(StringSSS, ssss, deep);
    SEQUENCE(ByteBoolD, bd, entries);
    SEQUENCE(ByteBoolDS, bds, tables);
    SEQUENCE(ByteByteSD, bsd, lists);
    SEQUENCE(ShortIntD, hd, numbers);
    SEQUENCE(StringStringD, td, texts);
    Test_ByteS bOut, bBack;
    Test_ShortS hOut;
    Test_IntS iOut;
    Test_LongS lOut, lBack;
    Test_FloatS fOut;
    Test_DoubleS dOut, dBack;
    Test_ByteBoolD dictionary;
    Ice_Int n;
    for (n = 0; n < 1000; ++n)
        ints[n] = n;
    strings[0] = texts[0].key = Ice_String_from("abc"), strings[1] = Ice_String_from("de");
    texts[1].key = strings[1], texts[0].value = texts[1].value = strings[0];
    byteLists[0] = byteLists[1] = lists[0].value = bs, lists[0].key = 7;
    stringLists[0] = stringLists[2] = ss, deep[0] = deep[1] = sss, tables[0] = tables[1] = bd;
    CALL(opByteS, (&prx, &bs, &bs, &bOut, &bBack));
    CHECK(bOut.size == 4 && bOut.data[0] == 0x22 && bBack.size == 8 && bBack.data[4] == 1);
    TWICE(opBoolS, BoolS, os, 6, 3);
    TWICE(opStringS, StringS, ss, 4, 2);
    TWICE(opByteSS, ByteSS, bss, 2, 4);
    TWICE(opStringSS, StringSS, sss, 6, 3);
    TWICE(opStringSSS, StringSSS, ssss, 4, 2);
    TWICE(opByteBoolD, ByteBoolD, bd, 2, 2);
    TWICE(opShortIntD, ShortIntD, hd, 2, 2);
    TWICE(opStringStringD, StringStringD, td, 2, 2);
    TWICE(opByteBoolDS, ByteBoolDS, bds, 4, 2);
    TWICE(opByteByteSD, ByteByteSD, bsd, 1, 1);
    CALL(opShortIntLongS, (&prx, &hs, &is, &ls, &hOut, &iOut, &lOut, &lBack));
    CHECK(hOut.data[2] == 3 && iOut.data[0] == 999 && lOut.size == 4 && lBack.data[1].low == 30);
    CALL(opFloatDoubleS, (&prx, &fs, &ds, &fOut, &dOut, &dBack));
    CHECK(fOut.data[1] == 1.11F && dOut.data[0] == 3.3e10 && dBack.size == 5);
    CALL(opIntS, (&prx, &is, &iOut));
    CHECK(iOut.size == 1000 && iOut.data[999] == -999);
    CALL(opByteBoolD1, (&prx, &bd, &dictionary));
    CHECK(*Test_ByteBoolD_find(&dictionary, 10) == 1 &&
          *Test_ByteBoolD_find(&dictionary, 100) == 0);
    CALL(opStringS1, (&prx, &ss, &ss));
    SAME(ss.data[1], "de");
}

static void modes(void) {
    static const Ice_ContextEntry context[] = {{"one", "ONE"}, {"two", "TWO"}, {0, 0}};
    static Ice_Byte room[2000], bytes[300];
    Test_MyDerivedClassPrx other = prx;
    Ice_Batch batch;
    Ice_Context heard;
    SEQUENCE(ByteS, bs, bytes);
    Ice_Int count, n;
    CALL(opVoid, (&prx));
    CALL(opIdempotent, (&prx));
    CALL(opNonmutating, (&prx));
    CALL(opDerived, (&prx));
    Ice_ObjectPrx_ice_context(&other, context);
    CALL(opContext, (&other, &heard));
    CHECK(heard.size == 2);
    SAME(*Ice_Context_find(&heard, Ice_String_from("two")), "TWO");
    other = prx;
    CALL(opByteSOnewayCallCount, (&prx, &count));
    Ice_ObjectPrx_ice_oneway(&other);
    CALL(opByteSOneway, (&other, &bs));
    Ice_ObjectPrx_ice_batchOneway(&other, &batch, room, (Ice_Int)sizeof room);
    for (n = 0; n < 10; ++n) /* more than the batch has room for: it is sent in parts */
        CALL(opByteSOneway, (&other, &bs));
    CHECK(Ice_ObjectPrx_ice_flushBatchRequests(&other) == ICE_OK);
    for (n = 0; n < 11; n += count) /* one-way calls may overtake nothing, but are not waited for */
        CALL(opByteSOnewayCallCount, (&prx, &count));
    CHECK(n == 11);
}

void Suite_call(Ice_CommunicatorPtr ic) {
    Ice_ObjectPrx base = Suite_proxy(ic, "test");
    static Test_MyClass1 v;
    Test_MyClass1* back;
    Test_MyStruct1 s, sBack;
    Test_StringS literals;
    CAST(Test_MyDerivedClass, &prx, &base);
    scalars();
    sequences();
    modes();
    Test_MyClass1_init(&v), Test_MyStruct1_init(&s);
    v.tesT = s.tesT = Ice_String_from("Test.MyClass1.testT");
    CALL(opMyClass1, (&prx, &v, &back));
    SAME(back->tesT, "Test.MyClass1.testT");
    CHECK(Ice_ObjectPrx_isNull(&back->myClass));
    CALL(opMyStruct1, (&prx, &s, &sBack));
    SAME(sBack.tesT, "Test.MyClass1.testT");
    CALL(opStringLiterals, (&prx, &literals));
    CHECK(literals.size == 31);
    SAME(literals.data[5], Test_s5);
    SAME(literals.data[9], Test_s9);
    SAME(literals.data[22], Test_ss0);
    SAME(literals.data[28], Test_su0);
    CALL(shutdown, (&prx));
}
