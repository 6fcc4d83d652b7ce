// SPDX-License-Identifier: MIT
//
// server: generates the dispatch functions, which read requests and call servants.

#include "c/context.h"
#include <set>

namespace {

// Returns the statement that calls the servant with the variables of the dispatch function.
std::string servantCall(const Declaration& d, const Operation& o) {
    std::string call =
        "status = ice_operations->" + cIdentifier(o.name) + "((" + cName(d) + "Ptr)self";
    for (const Slot& s : inVariables(o)) {
        if (s.isOptional)
            call += ", " + s.has + " ? " + s.pointer + " : 0";
        else
            call += ", " + (isByPointer(*s.type) ? s.pointer : s.value);
    }
    if (!isAmd(d, o)) {
        for (const Slot& s : outSlots(o, ""))
            call += (s.isOptional ? ", &" + s.has : std::string()) + ", " + s.pointer;
        if (!o.throws.empty())
            call += ", &ex";
    }
    return call + ", current);";
}

void declareVariables(Writer& w, const Declaration& d, const Operation& o) {
    bool amd = isAmd(d, o);
    w.line("const {c}_Operations *ice_operations = (const {c}_Operations *)ice_table;",
           {{"c", cName(d)}});
    if (sendsClasses(o))
        w.line("Ice_InputValues ice_values;");
    if (returnsClasses(o) && !amd)
        w.line("Ice_OutputValues ice_sent;");
    std::vector<Slot> slots = inVariables(o);
    if (!amd)
        for (const Slot& s : outSlots(o, ""))
            slots.push_back(s);
    for (const Slot& s : slots) {
        if (s.isOptional)
            w.line("Ice_Bool " + s.has + ";");
        w.line((isClass(*s.type) ? "const " : "") + cVariable(*s.type, s.value) + ";");
    }
    if (!amd && !o.throws.empty())
        w.line(exceptionType(d, o) + " ex;");
    w.line("Ice_Status status;");
}

void readParameters(Writer& w, const CContext& c, const Operation& o) {
    if (inVariables(o).empty()) {
        w.single("if (Ice_InputStream_endEmpty(is))", "return ICE_MARSHAL;");
        return;
    }
    readWithValues(w, c, inVariables(o), "ice_values");
    w.single("if (Ice_InputStream_end(is))", "return ICE_MARSHAL;");
}

void writeResults(Writer& w, const CContext& c, const Declaration& d, const Operation& o) {
    std::vector<Slot> outs = outSlots(o, "");
    bool sliced = isSliced(d, o);
    if (sliced && (!o.throws.empty() || returnsClasses(o)))
        w.line("os->sliced = 1;");
    if (!outs.empty())
        w.block("if (status == ICE_OK)", {}, [&] { writeWithValues(w, outs, "ice_sent"); });
    if (!o.throws.empty()) {
        w.single("if (status == ICE_USER_EXCEPTION)",
                 c.thrownAs(o) + "_Exception_writeToOutputStream(&ex, os);");
    }
    if (outs.empty() && o.throws.empty())
        w.line("(void)os;");
    w.line("return status;");
}

void dispatchOperation(Writer& w, const CContext& c, const Declaration& d, const Operation& o) {
    Writer::Values v = {{"n", operationName(d, o)}};
    w.line("static Ice_Status dispatch_{n}(Ice_ObjectPtr self, const void *ice_table,", v);
    w.line("        const Ice_Current *current, Ice_InputStreamPtr is, Ice_OutputStreamPtr os) {");
    w.indented([&] {
        declareVariables(w, d, o);
        w.single("if (!ice_operations->" + cIdentifier(o.name) + ")",
                 "return ICE_OPERATION_NOT_EXIST;");
        readParameters(w, c, o);
        if (!isAmd(d, o)) {
            for (const Slot& s : outSlots(o, ""))
                if (s.isOptional)
                    w.line(s.has + " = 0;");
            // the exception may contain slices of unknown types; the servant must get it with an
            // empty list of these slices
            if (throwsPreserved(c.unit, o))
                w.line("memset(&ex, 0, sizeof ex);");
            if (!o.throws.empty())
                w.line("ex.type = " + operationName(d, o) + "_none;");
        }
        w.line(servantCall(d, o));
        if (isAmd(d, o)) {
            w.line("(void)os;");
            if (hasResults(o))
                w.line("return status == ICE_OK ? ICE_UNKNOWN_EXCEPTION : status; /* must be "
                       "ICE_LATER */");
            else
                w.line("return status;");
        } else {
            writeResults(w, c, d, o);
        }
    });
    w.line("}");
}

void responseFunctions(Writer& w, const CContext& c, const Declaration& d, const Operation& o) {
    auto begin = [&] {
        w.line("Ice_OutputStreamPtr os = Ice_Reply_begin(reply);");
        w.single("if (!os)", "return ICE_CONNECTION_LOST;");
        if (isSliced(d, o) && (!o.throws.empty() || returnsClasses(o)))
            w.line("os->sliced = 1;");
    };
    w.function(responseSignature(d, o), {}, [&] {
        if (returnsClasses(o))
            w.line("Ice_OutputValues ice_sent;");
        begin();
        writeWithValues(w, responseSlots(o), "ice_sent");
        w.line("return Ice_Reply_end(reply, ICE_OK);");
    });
    if (o.throws.empty())
        return;
    w.function("Ice_Status {n}_exception(Ice_Reply *reply, const {n}_Exception *ex)",
               {{"n", operationName(d, o)}}, [&] {
                   begin();
                   w.line(c.thrownAs(o) + "_Exception_writeToOutputStream(ex, os);");
                   w.line("return Ice_Reply_end(reply, ICE_USER_EXCEPTION);");
               });
}

void interfaceTable(Writer& w, const Declaration& d) {
    Writer::Values v = {{"c", cName(d)}};
    w.line("static const Ice_Operation operations_{c}[] = {", v);
    for (const Operation& o : d.operations) {
        const std::string modes = o.idempotent ? "ICE_TAKES_IDEMPOTENT" : "ICE_TAKES_NORMAL";
        w.line(
            "    {\"{op}\", dispatch_{n}, {modes}},",
            {{"op", o.name},
             {"n", operationName(d, o)},
             {"modes", hasMetadata(o.metadata, ":broadcast") ? "ICE_TAKES_BROADCAST(" + modes + ")"
                                                             : modes}});
    }
    w.line("    {0, 0, 0}};");
    if (!d.bases.empty()) {
        w.line("static const Ice_Base bases_{c}[] = {", v);
        for (const Declaration* base : d.bases)
            w.line("    {&{b}_ice_interface, offsetof({c}_Operations, {b}_)},",
                   {{"c", cName(d)}, {"b", cName(*base)}});
        w.line("    {0, 0}};");
    }
    w.line("const Ice_Interface {c}_ice_interface = {operations_{c}, " +
               std::string(d.bases.empty() ? "0" : "bases_{c}") + "};",
           v);
}

// Returns the initialiser of the default operation table, which contains the application's
// functions and the tables of the bases.
std::string defaultOperations(const Declaration& top, const Declaration& d) {
    std::string list;
    for (const Declaration* base : d.bases)
        list += (list.empty() ? "" : ", ") + ("{" + defaultOperations(top, *base)) + "}";
    for (const Operation& o : d.operations)
        list += (list.empty() ? "" : ", ") + cName(top) + "_" + cOperation(o.name);
    return list.empty() ? "0" : list;
}

void initFunctions(Writer& w, const Declaration& d) {
    Writer::Values v = {{"c", cName(d)}, {"id", d.id()}};
    std::set<std::string> ids = {"::Ice::Object"};
    for (const Declaration* from : lineage(d)) {
        ids.insert(from->id());
        if (hasMetadata(from->metadata, ":maintenance"))
            ids.insert("::IceSoC::Maintenance");
        for (const Declaration* c = from->ofClass; c; c = c->base())
            ids.insert(c->id());
    }
    w.line("static Ice_Status dispatch_{c}(Ice_ObjectPtr self, const Ice_Current *current,", v);
    w.line("        Ice_InputStreamPtr is, Ice_OutputStreamPtr os) {");
    w.line("    const {c}_Operations *operations = ((const {c} *)self)->operations;", v);
    w.line("    return Ice_Object_dispatch(&{c}_ice_interface, operations, self, current, is, os);",
           v);
    w.line("}");
    w.function("void {c}_initWith({c}Ptr self, const {c}_Operations *operations)", v, [&] {
        w.line("static const char *const ids[] = {");
        for (const std::string& id : ids)
            w.line("    \"" + id + "\",");
        w.line("    0};");
        w.line("self->base.dispatch = dispatch_{c};", v);
        w.line("self->base.ids = ids;");
        w.line("self->base.id = \"{id}\";", v);
        w.line("self->operations = operations;");
    });
    w.function("void {c}_init({c}Ptr self)", v, [&] {
        w.line("static const {c}_Operations operations = {" + defaultOperations(d, d) + "};", v);
        w.line("{c}_initWith(self, &operations);", v);
    });
}

} // namespace

std::string serverFile(const CContext& c) {
    Writer w = c.beginSource("Dispatch: from requests to the application's servants.");
    bool preserved = false;
    c.eachOperation([&](const Declaration&, const Operation& o) {
        preserved = preserved || throwsPreserved(c.unit, o);
    });
    if (preserved) {
        w.blank();
        w.line("#include <string.h>");
    }
    c.each(Declaration::Kind::Interface, [&](const Declaration& d) {
        if (d.isForward)
            return;
        for (const Operation& o : d.operations) {
            w.blank();
            dispatchOperation(w, c, d, o);
            if (isAmd(d, o))
                responseFunctions(w, c, d, o);
        }
        w.blank();
        interfaceTable(w, d);
        w.blank();
        initFunctions(w, d);
    });
    return w.text();
}
