// SPDX-License-Identifier: MIT
//
// calls_test: tests calls between two communicators: servants, facets, one-way calls, batches,
// contexts, sizes, asynchronous calls.

#include "icec_pair.h"

extern "C" {
#include "ice_private.h"
}

namespace {

TEST_F(Calls, ACheckedCastAsksTheObjectForItsTypes) {
    Ice_ObjectPrx other;
    EXPECT_EQ(Ice_ObjectPrx_checkedCast(&other, &prx_, "::Test::Thing"), ICE_OK);
    EXPECT_FALSE(Ice_ObjectPrx_isNull(&other));
    EXPECT_EQ(Ice_ObjectPrx_checkedCast(&other, &prx_, "::Test::Else"), ICE_OK);
    EXPECT_TRUE(Ice_ObjectPrx_isNull(&other));
    EXPECT_EQ(servant_.calls, 0);
}

TEST_F(Calls, EachProxyKeepsTheReasonOfItsFailure) {
    Ice_ObjectPrx missing = here().proxy("cat/missing -f side:loop"),
                  fails = here().proxy("thing:loop"), works = fails;
    Ice_Failure failure;
    EXPECT_EQ(call(missing, "first"), ICE_OBJECT_NOT_EXIST);
    servant_.run = [](const Ice_Current& current, Ice_InputStreamPtr, Ice_OutputStreamPtr) {
        return str(current.operation) == "works" ? ICE_OK : ICE_LIMIT;
    };
    EXPECT_EQ(call(fails, "fails"), ICE_UNKNOWN_EXCEPTION);
    EXPECT_EQ(reason(fails), Ice_Status_text(ICE_LIMIT))
        << "the reason must be the text of the status";
    Ice_ObjectPrx_failure(&works, &failure);
    EXPECT_EQ(failure.unknown.size + failure.identity.name.size, 0)
        << "a proxy without calls has no failure";
    EXPECT_EQ(call(works, "works"), ICE_OK);
    Ice_ObjectPrx_failure(&works, &failure);
    EXPECT_EQ(failure.unknown.size + failure.identity.name.size + failure.operation.size, 0);
    Ice_ObjectPrx_failure(&missing, &failure);
    EXPECT_EQ(str(failure.identity.name), "missing");
    EXPECT_EQ(str(failure.identity.category), "cat");
    EXPECT_EQ(str(failure.facet), "side");
    EXPECT_EQ(str(failure.operation), "first");
    EXPECT_EQ(failure.unknown.size, 0);
    Ice_ObjectPrx_failure(&fails, &failure);
    EXPECT_EQ(failure.unknown.size, 0) << "the text is invalid after the reply was released";
}

// Makes a call with the string `mine` as result. The result stays in the buffer of the reply.
Ice_String askString(Ice_ObjectPrx& prx, const std::string& mine, Ice_Status expected = ICE_OK) {
    Ice_String result = {0, nullptr};
    Ice_InputStreamPtr is;
    Ice_OutputStreamPtr os = Ice_ObjectPrx_begin(&prx, "op", ICE_RESULTS);
    if (!os) {
        EXPECT_EQ(prx.status, expected);
        return result;
    }
    Ice_OutputStream_writeText(os, mine.c_str());
    EXPECT_EQ(Ice_ObjectPrx_invoke(&prx, &is), ICE_OK);
    result = Ice_InputStream_readString(is);
    EXPECT_EQ(Ice_ObjectPrx_end(&prx, ICE_OK), expected);
    return result;
}

Ice_Status echo(const Ice_Current&, Ice_InputStreamPtr is, Ice_OutputStreamPtr os) {
    Ice_OutputStream_writeString(os, Ice_InputStream_readString(is));
    return ICE_OK;
}

TEST_F(Calls, ResultsInTheBufferOfAProxyStayUntilItsNextCall) {
    Ice_ObjectPrx own = here().proxy("thing:loop"), other = own;
    alignas(8) U32 buffer[32];
    Ice_ObjectPrx_setReplyBuffer(&own, buffer, sizeof buffer);
    servant_.run = echo;
    Ice_String result = askString(own, "mine");
    for (int i = 0; i < 2 * ICE_CALLS; ++i)
        askString(other, "another one's");
    EXPECT_EQ(str(result), "mine");
}

TEST_F(Calls, EachTaskKeepsItsLastResultAndTheNumberOfTasksIsLimited) {
    static int task;
    Ice_Os os = Ice_Os_none;
    os.task = [](void*) { return task; };
    Ice_Communicator_setOs(&here().ic, &os, nullptr);
    servant_.run = echo;
    std::vector<Ice_ObjectPrx> proxies(ICE_CALLS + 1, here().proxy("thing:loop"));
    std::vector<Ice_String> results;
    for (int i = 0; i < 3 * ICE_CALLS; ++i) {
        task = i % ICE_CALLS;
        results.push_back(askString(proxies[task], "call " + std::to_string(i)));
    }
    task = ICE_CALLS;
    askString(proxies[task], "one too many", ICE_LIMIT);
    for (int i = 2 * ICE_CALLS; i < 3 * ICE_CALLS; ++i)
        EXPECT_EQ(str(results[i]), "call " + std::to_string(i));
    task = 0;
    EXPECT_EQ(call(proxies[0], "a call without results lets go"), ICE_OK);
    task = ICE_CALLS;
    EXPECT_EQ(str(askString(proxies[task], "now there is one")), "now there is one");
}

TEST_F(Calls, CategoriesFacetsAndDefaultServantsAreFoundInIcesOrder) {
    Servant category, facet, any;
    auto& adapter = there().adapter;
    EXPECT_EQ(Ice_ObjectAdapter_addDefaultServant(&adapter, &category.base, "cat"), ICE_OK);
    EXPECT_EQ(Ice_ObjectAdapter_addFacet(&adapter, &facet.base, "thing", "side"), ICE_OK);
    EXPECT_EQ(Ice_ObjectAdapter_add(&adapter, &facet.base, "thing"), ICE_LIMIT) << "taken";
    auto to = [&](const char* string) {
        Ice_ObjectPrx prx = here().proxy(string);
        return call(prx, "op");
    };
    EXPECT_EQ(to("cat/anyone:loop"), ICE_OK);
    EXPECT_EQ(category.calls, 1);
    EXPECT_EQ(to("thing -f side:loop"), ICE_OK);
    EXPECT_EQ(facet.calls, 1);
    EXPECT_EQ(to("thing -f none:loop"), ICE_FACET_NOT_EXIST);
    EXPECT_EQ(to("other:loop"), ICE_OBJECT_NOT_EXIST);
    EXPECT_EQ(Ice_ObjectAdapter_addDefaultServant(&adapter, &any.base, ""), ICE_OK);
    EXPECT_EQ(to("other:loop"), ICE_OK);
    EXPECT_EQ(to("cat/anyone:loop"), ICE_OK);
    EXPECT_EQ(any.calls, 1);
    EXPECT_EQ(category.calls, 2);
    EXPECT_EQ(Ice_ObjectAdapter_removeDefaultServant(&adapter, ""), ICE_OK);
    EXPECT_EQ(Ice_ObjectAdapter_removeFacet(&adapter, "thing", "side"), ICE_OK);
    EXPECT_EQ(Ice_ObjectAdapter_removeFacet(&adapter, "thing", "side"), ICE_OBJECT_NOT_EXIST);
    EXPECT_EQ(to("thing -f side:loop"), ICE_FACET_NOT_EXIST);
    EXPECT_EQ(Ice_ObjectAdapter_find(&adapter, "thing"), &servant_.base);
    EXPECT_EQ(Ice_ObjectAdapter_remove(&adapter, "thing"), ICE_OK);
    EXPECT_EQ(Ice_ObjectAdapter_find(&adapter, "thing"), nullptr);
    EXPECT_EQ(to("thing:loop"), ICE_OBJECT_NOT_EXIST);
}

TEST_F(Calls, ABatchIsOneMessageAndIsSentWhenFullOrFlushed) {
    std::vector<int> got;
    int messages = 0;
    here().loop.tap = [&](const Bytes& m) { messages += m[8] == 1; };
    servant_.run = [&](const Ice_Current& current, Ice_InputStreamPtr is, Ice_OutputStreamPtr) {
        EXPECT_EQ(current.requestId, 0);
        got.push_back(Ice_InputStream_readInt(is));
        return ICE_OK;
    };
    Ice_Batch batch;
    Ice_Byte data[200];
    Ice_ObjectPrx_ice_batchOneway(&prx_, &batch, data, sizeof data);
    EXPECT_EQ(Ice_ObjectPrx_ice_flushBatchRequests(&prx_), ICE_OK)
        << "an empty batch is sent successfully";
    for (int i = 0; i < 5; ++i)
        EXPECT_EQ(call(prx_, "op", i), ICE_OK);
    settle();
    EXPECT_TRUE(got.empty());
    EXPECT_EQ(Ice_ObjectPrx_ice_flushBatchRequests(&prx_), ICE_OK);
    settle();
    EXPECT_EQ(got, std::vector<int>({0, 1, 2, 3, 4}));
    EXPECT_EQ(messages, 1);
    for (int i = 0; i < 20; ++i) // more batched requests than fit into a message
        EXPECT_EQ(call(prx_, "op", i), ICE_OK);
    EXPECT_EQ(Ice_ObjectPrx_ice_flushBatchRequests(&prx_), ICE_OK);
    settle();
    EXPECT_EQ(got.size(), 25u);
    EXPECT_GT(messages, 2);
    Ice_Int out;
    EXPECT_EQ(call(prx_, "op", 0, &out), ICE_TWOWAY_ONLY);
}

TEST_F(Calls, ContextsArrive) {
    std::string seen;
    servant_.run = [&](const Ice_Current& current, Ice_InputStreamPtr, Ice_OutputStreamPtr) {
        Ice_String key, value;
        seen = Ice_Current_context(&current, "who", &value) ? str(value) : "-";
        EXPECT_FALSE(Ice_Current_context(&current, "else", &value));
        for (Ice_Int i = 0; Ice_Current_contextAt(&current, i, &key, &value); ++i)
            seen += " " + str(key) + "=" + str(value);
        EXPECT_FALSE(Ice_Current_contextAt(&current, -1, &key, &value));
        return ICE_OK;
    };
    const Ice_ContextEntry context[] = {{"a", ""}, {"who", "me"}, {nullptr, nullptr}};
    Ice_ObjectPrx_ice_context(&prx_, context);
    EXPECT_EQ(call(prx_, "op"), ICE_OK);
    EXPECT_EQ(seen, "me a= who=me");
    Ice_ObjectPrx_ice_context(&prx_, nullptr);
    EXPECT_EQ(call(prx_, "op"), ICE_OK);
    EXPECT_EQ(seen, "-");
}

TEST_F(Calls, EveryLimitIsReportedWithItsNameAndValue) {
    static Ice_Byte much[ICE_MESSAGE_MAX];
    Ice_Int out;
    servant_.run = [&](const Ice_Current& current, Ice_InputStreamPtr is, Ice_OutputStreamPtr os) {
        if (str(current.operation) == "arena") {
            (void)Ice_InputStream_allocate(is, 1000, 8);
            return ICE_MARSHAL; // generated code returns the same status
        }
        if (str(current.operation) == "bound") {
            is->failed = ICE_FAILED_BOUND;
            is->bound = "over a bound of Slice";
        } else
            Ice_OutputStream_writeBlob(os, much, str(current.operation) == "reply" ? 2000 : 8190);
        return ICE_OK;
    };
    EXPECT_EQ(call(prx_, "arena", 0, &out), ICE_UNKNOWN_LOCAL_EXCEPTION);
    EXPECT_EQ(reason(prx_), "::Ice::MarshalException: over ICE_ARENA_BYTES (2048)");
    EXPECT_EQ(call(prx_, "bound", 0, &out), ICE_UNKNOWN_LOCAL_EXCEPTION);
    EXPECT_EQ(reason(prx_), "over a bound of Slice");
    EXPECT_EQ(call(prx_, "message", 0, &out), ICE_UNKNOWN_LOCAL_EXCEPTION);
    EXPECT_EQ(reason(prx_), "::Ice::MarshalException: over ICE_RESULT_MAX (8192)");
    EXPECT_EQ(call(prx_, "reply", 0, &out), ICE_MARSHAL);
    EXPECT_EQ(
        reason(prx_),
        "::Ice::MarshalException: over ICE_REPLY_MAX (1024): see Ice_ObjectPrx_setReplyBuffer");
    alignas(8) static U32 buffer[2048];
    Ice_ObjectPrx_setReplyBuffer(&prx_, buffer, sizeof buffer);
    EXPECT_EQ(call(prx_, "reply", 0, &out), ICE_OK);
    Ice_OutputStreamPtr os = Ice_ObjectPrx_begin(&prx_, "op", 0);
    Ice_InputStreamPtr is;
    os->failed = ICE_FAILED_BOUND, os->bound = "another one";
    EXPECT_EQ(Ice_ObjectPrx_end(&prx_, Ice_ObjectPrx_invoke(&prx_, &is)), ICE_MARSHAL);
    EXPECT_EQ(reason(prx_), "another one");
    os = Ice_ObjectPrx_begin(&prx_, "op", 0);
    Ice_OutputStream_writeBlob(os, much, sizeof much);
    EXPECT_EQ(Ice_ObjectPrx_end(&prx_, Ice_ObjectPrx_invoke(&prx_, &is)), ICE_MARSHAL);
    EXPECT_EQ(reason(prx_), "::Ice::MarshalException: over ICE_REQUEST_MAX (8192)");
    servant_.run = [](const Ice_Current&, Ice_InputStreamPtr from, Ice_OutputStreamPtr) {
        (void)Ice_InputStream_readLong(from);
        return ICE_OK;
    };
    EXPECT_EQ(call(prx_, "op"), ICE_UNKNOWN_LOCAL_EXCEPTION);
    EXPECT_EQ(reason(prx_),
              "::Ice::MarshalException: malformed, or not of the type that is expected");
    std::vector<Ice_ObjectPrx> busy(ICE_CALLS, prx_);
    for (Ice_ObjectPrx& each : busy)
        each.call = icec_takeCall(&here().ic);
    EXPECT_EQ(call(prx_, "op"), ICE_LIMIT);
    EXPECT_EQ(reason(prx_), "::Ice::MemoryLimitException: over ICE_CALLS (4)");
    for (Ice_ObjectPrx& each : busy)
        here().ic.calls[each.call].state = ICE_CALL_FREE;
}

TEST_F(Calls, AnOperationMayCallBackBeforeItAnswers) {
    Servant back;
    ASSERT_EQ(Ice_ObjectAdapter_add(&here().adapter, &back.base, "back"), ICE_OK);
    back.run = [](const Ice_Current&, Ice_InputStreamPtr is, Ice_OutputStreamPtr os) {
        Ice_OutputStream_writeInt(os, Ice_InputStream_readInt(is) + 1);
        return ICE_OK;
    };
    servant_.run = [&](const Ice_Current&, Ice_InputStreamPtr is, Ice_OutputStreamPtr os) {
        Ice_Int v = Ice_InputStream_readInt(is);
        Ice_ObjectPrx prx = there().proxy("back:loop");
        EXPECT_EQ(call(prx, "next", v, &v), ICE_OK);
        EXPECT_EQ(call(prx, "next", v, &v), ICE_OK);
        Ice_OutputStream_writeInt(os, v);
        return ICE_OK;
    };
    Ice_ObjectPrx prx = here().proxy("thing:loop");
    for (int i = 0; i < 100; ++i) {
        ASSERT_EQ(ask(prx, "op", i), i + 2);
    }
}

} // namespace
