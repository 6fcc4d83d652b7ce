// SPDX-License-Identifier: MIT
//
// servant_calls: the servant's operations: answered at once, waited for, or answered later;
// events.

#include "c/names.h"
#include "c/operations.h"
#include "hw/servant.h"

namespace hw {
namespace {

std::string number(unsigned n) {
    return std::to_string(n) + "U";
}

const Declaration& interfaceOf(const Block& b) {
    return *b.interface;
}

std::string nameOf(const Block& b, const Call& c) {
    return operationName(interfaceOf(b), *c.operation);
}

// M_I_Core_op_begin moves the parameters in and starts the core; M_I_Core_op_end moves results out.
std::string part(const Block& b, const Call& c, const char* which) {
    return coreType(b) + "_" + cOperation(c.operation->name) + "_" + which;
}

std::string beginSignature(const Block& b, const Call& c) {
    return "Ice_Status " + part(b, c, "begin") + "(" + coreType(b) + " *hw_core" +
           inParameters(*c.operation) + ")";
}

std::string endSignature(const Block& b, const Call& c) {
    return "Ice_Status " + part(b, c, "end") + "(" + coreType(b) + " *hw_core" +
           outParameters(interfaceOf(b), *c.operation) + ")";
}

std::string arguments(const std::vector<Slot>& slots) {
    std::string list;
    for (const Slot& s : slots)
        list += ", " + (isByPointer(*s.type) ? s.pointer : s.value);
    return list;
}

void failUnlessOk(Writer& w, const std::string& call) {
    w.line("hw_status = hwStatus(" + call + ");");
    w.line("if (hw_status != ICE_OK)");
    w.nested("return hw_status;");
}

void answerFunction(Writer& w, const Block& b, const Call& c) {
    const Operation& o = *c.operation;
    w.blank();
    w.block("static void " + c.name + "_answer(" + coreType(b) + " *hw_core, Ice_Status hw_status)",
            {}, [&] {
                std::string pointers;
                for (const Slot& s : outSlots(o, "")) {
                    w.line("static " + cVariable(*s.type, s.value) + "; /* off the stack */");
                    pointers += ", &" + s.value;
                }
                if (!o.throws.empty()) {
                    w.line("static " + exceptionType(interfaceOf(b), o) + " ex;");
                    pointers += ", &ex";
                }
                w.line("Ice_Reply hw_reply = hw_core->" + c.name + "_reply;");
                w.line("if (hw_status == ICE_OK)");
                w.nested("hw_status = " + part(b, c, "end") + "(hw_core" + pointers + ");");
                w.line("hw_core->core.later[" + std::to_string(c.bit) + "] = 0;");
                w.line("if (hw_status == ICE_OK)");
                w.nested("(void)" + nameOf(b, c) + "_response(&hw_reply" +
                         arguments(outSlots(o, "")) + ");");
                if (!o.throws.empty()) {
                    w.line("else if (hw_status == ICE_USER_EXCEPTION)");
                    w.nested("(void)" + nameOf(b, c) + "_exception(&hw_reply, &ex);");
                }
                w.block("else", {}, [&] {
                    w.line("(void)Ice_Reply_begin(&hw_reply);");
                    w.line("(void)Ice_Reply_end(&hw_reply, hw_status);");
                });
            });
}

std::string takeSignature(const Block& b, const Call& c) {
    std::string parameters;
    for (const Slot& s : inVariables(*c.operation))
        parameters += ", " + cVariable(*s.type, "*" + s.value);
    return "Ice_Status " + part(b, c, "take") + "(" + coreType(b) + " *hw_core" + parameters + ")";
}

void eventFunctions(Writer& w, const Block& b, const Listener& l, const Call& c) {
    const Operation& o = *c.operation;
    w.blank();
    w.block(takeSignature(b, c), {}, [&] {
        resultVariables(w, c);
        readResults(w, b, c);
        w.line("Hw_Core_act(&hw_core->core, " + number(c.bit) +
               "); /* taken: the next may come */");
        w.line("return ICE_OK;");
    });
    w.blank();
    w.block("static void " + c.name + "_event(" + coreType(b) + " *hw_core)", {}, [&] {
        std::string pointers;
        w.line("Ice_ObjectPrx hw_proxy;");
        for (const Slot& s : inVariables(o)) {
            w.line(cVariable(*s.type, s.value) + ";");
            pointers += ", " + s.pointer;
        }
        w.line("if (" + part(b, c, "take") + "(hw_core" + pointers +
               ") == ICE_OK && Hw_Listener_get(&hw_core->" + l.name + ", &hw_proxy))");
        w.nested("(void)" + cProxy(*c.owner) + "_" + cOperation(o.name) + "(&hw_proxy" +
                 arguments(inVariables(o)) + ");");
    });
}

} // namespace

void amdDeclarations(Writer& w, const Block& b, const Call& c) {
    w.line("/* " + c.operation->name + ", which is answered later, in two parts. */");
    w.line(beginSignature(b, c) + ";");
    w.line(endSignature(b, c) + ";");
}

void eventDeclaration(Writer& w, const Block& b, const Call& c) {
    w.line("/* The values of the event " + c.operation->name + ", which may then come again. */");
    w.line(takeSignature(b, c) + ";");
}

void amdFunctions(Writer& w, const Block& b, const Call& c) {
    std::string bit = number(c.bit);
    w.blank();
    w.block(beginSignature(b, c), {}, [&] {
        w.line("Ice_Status hw_status;");
        w.line("if (hw_core->core.later[" + std::to_string(c.bit) + "])");
        w.nested("return ICE_LIMIT; /* the call before is not answered yet */");
        failUnlessOk(w, "Hw_Core_ready(&hw_core->core, " + bit + ")");
        writeParameters(w, b, c);
        w.line("Hw_Core_begin(&hw_core->core, " + bit + ", " + number(c.timeout) + ");");
        w.line("return ICE_OK;");
    });
    w.blank();
    w.block(endSignature(b, c), {}, [&] {
        resultVariables(w, c);
        if (!hasResults(*c.operation) && c.thrown.empty())
            w.line("(void)hw_core;");
        readResults(w, b, c);
        w.line("return ICE_OK;");
    });
    w.blank();
    w.block(servantSignature(interfaceOf(b), *c.operation, nameOf(b, c)), {}, [&] {
        w.line(coreType(b) + " *hw_core = (" + coreType(b) + " *)self;");
        w.line("Ice_Status hw_status = " + part(b, c, "begin") + "(hw_core" +
               arguments(inSlots(*c.operation)) + ");");
        w.line("if (hw_status != ICE_OK)");
        w.nested("return hw_status;");
        w.line("Ice_Current_later(current, &hw_core->" + c.name + "_reply);");
        w.line("Hw_Core_later(&hw_core->core, " + bit + ");");
        w.line("return ICE_LATER;");
    });
    answerFunction(w, b, c);
}

void operation(Writer& w, const Block& b, const Call& c) {
    w.blank();
    w.block(servantSignature(interfaceOf(b), *c.operation, nameOf(b, c)), {}, [&] {
        w.line(coreType(b) + " *hw_core = (" + coreType(b) + " *)self;");
        resultVariables(w, c);
        if (c.isLong)
            w.line("Ice_Status hw_status;");
        w.line("(void)current;");
        if (c.isLong)
            failUnlessOk(w, "Hw_Core_ready(&hw_core->core, " + number(c.bit) + ")");
        writeParameters(w, b, c);
        if (c.isLong)
            failUnlessOk(w, "Hw_Core_run(&hw_core->core, " + number(c.bit) + ", " +
                                number(c.timeout) + ")");
        else
            w.line("Hw_Core_act(&hw_core->core, " + number(c.bit) + ");");
        readResults(w, b, c);
        w.line(b.hasOwnClock && !c.isLong
                   ? "return Hw_Core_answers(&hw_core->core) ? ICE_OK : ICE_TIMEOUT;"
                   : "return ICE_OK;");
    });
}

void listenerFunctions(Writer& w, const Block& b, const Listener& l) {
    const Field& p = l.operation->parameters.front();
    w.blank();
    w.block(
        servantSignature(interfaceOf(b), *l.operation, operationName(interfaceOf(b), *l.operation)),
        {}, [&] {
            w.line("(void)current;");
            w.line("Hw_Listener_set(&((" + coreType(b) + " *)self)->" + l.name + ", " +
                   cParameter(*l.operation, p) + ");");
            w.line("return ICE_OK;");
        });
    for (size_t i = l.first; i < l.first + l.count; ++i)
        eventFunctions(w, b, l, b.calls[i]);
}

void pollFunction(Writer& w, const Block& b) {
    bool hasAmd = false, hasEvents = false;
    for (const Call& c : b.calls) {
        hasAmd |= c.isAmd;
        hasEvents |= c.isEvent;
    }
    w.blank();
    w.block("U32 " + coreType(b) + "_poll(" + coreType(b) + " *self, U32 nowMs)", {}, [&] {
        w.line("U32 next = HW_NEVER;");
        if (hasAmd)
            w.line("Hw_Status status;");
        else
            w.line("(void)nowMs;");
        if (!hasAmd && !hasEvents)
            w.line("(void)self;");
        for (const Call& c : b.calls) {
            if (c.isAmd) {
                w.line("if (Hw_Core_ended(&self->core, " + number(c.bit) +
                       ", nowMs, &status, &next))");
                w.nested(c.name + "_answer(self, hwStatus(status));");
            }
            if (c.isEvent) {
                w.line("if (Hw_Core_event(&self->core, " + number(c.bit) + "))");
                w.nested(c.name + "_event(self);");
            }
        }
        w.line("return next;");
    });
}

} // namespace hw
