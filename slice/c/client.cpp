// SPDX-License-Identifier: MIT
//
// client: generates proxies: synchronous calls in one file, asynchronous calls in another.

#include "c/context.h"

namespace {

std::string mode(const Operation& o) {
    std::string m = !o.idempotent                            ? "ICE_NORMAL"
                    : hasMetadata(o.metadata, "nonmutating") ? "ICE_NONMUTATING"
                                                             : "ICE_IDEMPOTENT";
    return hasResults(o) || !o.throws.empty() ? m + " | ICE_RESULTS" : m;
}

// Writes the declarations at the start of the function for a synchronous or asynchronous call.
void beginCall(Writer& w, const Operation& o) {
    w.line("Ice_OutputStreamPtr os = Ice_ObjectPrx_begin(self, \"{op}\", {mode});",
           {{"op", o.name}, {"mode", mode(o)}});
}

void writeParameters(Writer& w, const Declaration& d, const Operation& o) {
    w.single("if (!os)", "return (Ice_Status)self->status;");
    if (sendsClasses(o) && isSliced(d, o))
        w.line("os->sliced = 1;");
    writeWithValues(w, inSlots(o), "ice_values");
}

// Writes code that reads an exception into `to`, if the operation declares exceptions. A servant in
// Python can throw exceptions that the operation does not declare; these become
// ICE_UNKNOWN_USER_EXCEPTION.
void readException(Writer& w, const CContext& c, const Operation& o, const std::string& to) {
    bool isAsked = !o.throws.empty() && to == "ex"; // the caller may pass 0 for `ex`
    w.line(isAsked ? "if (status == ICE_USER_EXCEPTION && ex)"
                   : "if (status == ICE_USER_EXCEPTION)");
    w.nested("status = " + (o.throws.empty() ? "ICE_UNKNOWN_USER_EXCEPTION;"
                                             : c.thrownAs(o) + "_Exception_readFromInputStream(" +
                                                   to + ", is);"));
}

void syncFunction(Writer& w, const CContext& c, const Declaration& d, const Operation& o) {
    w.block(proxySignature(d, o), {}, [&] {
        if (sendsClasses(o))
            w.line("Ice_OutputValues ice_values;");
        if (returnsClasses(o))
            w.line("Ice_InputValues ice_received;");
        w.line("Ice_InputStreamPtr is = 0;");
        beginCall(w, o);
        w.line("Ice_Status status;");
        writeParameters(w, d, o);
        w.line("status = Ice_ObjectPrx_invoke(self, &is);");
        if (hasResults(o)) {
            w.block("if (status == ICE_OK)", {}, [&] {
                readWithValues(w, c, outSlots(o, "*"), "ice_received");
                w.line("(void)Ice_InputStream_end(is);");
            });
        }
        readException(w, c, o, "ex");
        w.line("return Ice_ObjectPrx_end(self, status);");
    });
}

void casts(Writer& w, const Declaration& d) {
    Writer::Values v = {{"p", cProxy(d)}, {"c", cName(d.ofClass ? *d.ofClass : d)}};
    w.function("Ice_Status {p}_checkedCast({p}Ptr self, const Ice_ObjectPrx *from)", v, [&] {
        w.line("return Ice_ObjectPrx_checkedCast(self, from, {c}_ice_staticId);", v);
    });
    w.function("void {p}_uncheckedCast({p}Ptr self, const Ice_ObjectPrx *from)", v,
               [&] { w.line("*self = *from;"); });
}

void completedFunction(Writer& w, const CContext& c, const Declaration& d, const Operation& o) {
    Writer::Values v = {{"p", cProxy(d) + "_" + cOperation(o.name)},
                        {"t", operationName(d, o) + "_Async"}};
    w.block("static void {p}_completed(void *cookie, Ice_Status status, Ice_InputStreamPtr is)", v,
            [&] {
                w.line("{t} *call = ({t} *)cookie;", v);
                if (hasResults(o)) {
                    w.block("if (status == ICE_OK)", {}, [&] {
                        if (returnsClasses(o))
                            w.line("Ice_InputValues values;");
                        readWithValues(w, c, outSlots(o, "call->"), "values");
                        w.single("if (Ice_InputStream_end(is))", "status = ICE_MARSHAL;");
                    });
                }
                readException(w, c, o, "&call->exception");
                if (!hasResults(o) && o.throws.empty())
                    w.line("(void)is;");
                w.line("call->status = status;");
                w.line("call->done = 1;");
                w.single("if (call->completed)", "call->completed(call);");
            });
}

void asyncFunction(Writer& w, const CContext& c, const Declaration& d, const Operation& o) {
    w.blank();
    completedFunction(w, c, d, o);
    w.function(asyncSignature(d, o), {}, [&] {
        if (sendsClasses(o))
            w.line("Ice_OutputValues ice_values;");
        beginCall(w, o);
        writeParameters(w, d, o);
        w.line("call->done = 0;");
        w.line("return Ice_ObjectPrx_invokeAsync(self, " + cProxy(d) + "_" + cOperation(o.name) +
               "_completed, call);");
    });
}

} // namespace

std::string clientFile(const CContext& c) {
    Writer w = c.beginSource("Proxies: synchronous calls.");
    c.each(Declaration::Kind::Interface, [&](const Declaration& d) {
        if (d.isForward)
            return;
        casts(w, d);
        for (const Operation& o : d.operations) {
            w.blank();
            syncFunction(w, c, d, o);
        }
    });
    return w.text();
}

std::string asyncFile(const CContext& c) {
    Writer w = c.beginSource("Proxies: asynchronous calls.");
    c.eachOperation([&](const Declaration& d, const Operation& o) { asyncFunction(w, c, d, o); });
    return w.text();
}
