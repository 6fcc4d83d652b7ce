// SPDX-License-Identifier: MIT
//
// fuzz_values: fuzzes graphs of instances, and exceptions, in generated code, with libFuzzer.
//
// An input is read as a message. Every second input is first converted to a valid message with a
// graph that its bytes describe, and this message is then damaged. The instances that were read are
// written in each encoding and format. If the written message can be read again, writing it once
// more must give the same bytes.

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

extern "C" {
#include "Graph.h"
}

namespace {

using Bytes = std::vector<Ice_Byte>;

U32 arena[16384];
Ice_Byte room[65536];

struct Format {
    Ice_Byte minor, sliced;
};
const Format formats[] = {{0, 0}, {1, 0}, {1, 1}};

Ice_InputStream reader(const Bytes& bytes, Ice_Byte minor, size_t arenaBegin) {
    Ice_InputStream is;
    static const Ice_Byte none = 0;
    Ice_InputStream_init(&is, bytes.empty() ? &none : bytes.data(),
                         static_cast<Ice_Int>(bytes.size()));
    is.minor = minor;
    is.arena = arena + arenaBegin;
    is.arenaSize = static_cast<Ice_Int>(sizeof arena / sizeof *arena / 2);
    return is;
}

Ice_OutputStream writer(Format format) {
    Ice_OutputStream os;
    Ice_OutputStream_init(&os, room, sizeof room);
    os.minor = format.minor;
    os.sliced = format.sliced;
    return os;
}

// ---- an operation with two parameters: a Node and an Object

struct Parameters {
    Graph_Node* a;
    Ice_Value* b;
};

bool read(Parameters& p, const Bytes& bytes, Ice_Byte minor, size_t arenaBegin) {
    Ice_InputStream is = reader(bytes, minor, arenaBegin);
    Ice_InputValues values;
    Ice_InputStream_beginValues(&is, &values, Graph_ice_valueTypes);
    Ice_InputStream_readValue(&is, &p.a, &Graph_Node_type);
    Ice_InputStream_readValue(&is, &p.b, nullptr);
    Ice_InputStream_endValues(&is);
    return !is.failed;
}

bool write(const Parameters& p, Format format, Bytes& bytes) {
    Ice_OutputStream os = writer(format);
    Ice_OutputValues values;
    Ice_OutputStream_beginValues(&os, &values);
    Ice_OutputStream_writeValue(&os, reinterpret_cast<const Ice_Value*>(p.a));
    Ice_OutputStream_writeValue(&os, p.b);
    Ice_OutputStream_endValues(&os);
    bytes.assign(room, room + os.size);
    return !os.failed;
}

// ---- an operation with exceptions

bool read(Graph_Maker_make_Exception& ex, const Bytes& bytes, Ice_Byte minor, size_t arenaBegin) {
    Ice_InputStream is = reader(bytes, minor, arenaBegin);
    return Graph_Maker_make_Exception_readFromInputStream(&ex, &is) == ICE_USER_EXCEPTION;
}

bool write(const Graph_Maker_make_Exception& ex, Format format, Bytes& bytes) {
    Ice_OutputStream os = writer(format);
    Graph_Maker_make_Exception_writeToOutputStream(&ex, &os);
    bytes.assign(room, room + os.size);
    return !os.failed;
}

template <class What> void roundTrip(const What& what) {
    for (Format format : formats) {
        Bytes first, second;
        What again{};
        // The second write may fail because of a limit of the run time (instances, types, waiting
        // pointers).
        if (!write(what, format, first) ||
            !read(again, first, format.minor, sizeof arena / sizeof *arena / 2))
            continue;
        if (!write(again, format, second) || first != second) {
            std::fprintf(stderr, "not the same a second time, in 1.%d, sliced %d\n", format.minor,
                         format.sliced);
            std::abort();
        }
    }
}

// Writes a message with the graph that the bytes describe.
template <class What> Bytes described(const uint8_t* data, size_t size, Format format) {
    static Graph_Leaf nodes[8];
    static Graph_Plain plain;
    static Graph_Node* all[3];
    static Graph_Named_Entry named;
    size_t at = 0;
    auto next = [&] { return at < size ? data[at++] : uint8_t{0}; };
    auto pick = [&]() -> Graph_Node* {
        unsigned n = next();
        return n % 9 == 8 ? nullptr : &nodes[n % 8].base;
    };
    Graph_Plain_init(&plain);
    for (Graph_Leaf& n : nodes) {
        if (next() & 1)
            Graph_Leaf_init(&n);
        else
            Graph_Node_init(&n.base);
        n.base.id = next();
        n.base.next = pick();
        n.base.has_other = next() & 1;
        n.base.other = pick();
        n.base.has_text = next() & 1;
        n.base.text = Ice_String_from("text");
        n.all.size = next() % 4;
        n.all.data = all;
        n.named.size = next() & 1;
        n.named.data = &named;
    }
    for (Graph_Node*& n : all)
        n = pick();
    named = {Ice_String_from("key"), pick()};
    plain.any = next() & 1 ? &plain.ice_value : reinterpret_cast<Ice_Value*>(pick());
    Bytes bytes;
    What what{};
    if constexpr (std::is_same_v<What, Parameters>) {
        what = {pick(), &plain.ice_value};
    } else if (next() & 1) {
        what.type = What::Graph_Maker_make_Worse;
        what.u.Worse.base.why = Ice_String_from("why");
        what.u.Worse.base.node = pick();
        what.u.Worse.has_plain = next() & 1;
        what.u.Worse.plain = &plain;
    } else {
        what.type = What::Graph_Maker_make_Failure;
        what.u.Failure.why = Ice_String_from("");
        what.u.Failure.node = pick();
    }
    (void)write(what, format, bytes);
    // the damage may include the names of types; their slices are then unknown
    while (at + 2 < size && !bytes.empty()) {
        size_t where = (data[at] << 8 | data[at + 1]) % bytes.size();
        bytes[where] = data[at + 2];
        at += 3;
    }
    return bytes;
}

template <class What> void one(const uint8_t* data, size_t size, Format format, bool describes) {
    Bytes bytes = describes ? described<What>(data, size, format) : Bytes(data, data + size);
    What what{};
    if (read(what, bytes, format.minor, 0))
        roundTrip(what);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    if (size == 0)
        return 0;
    Format format = formats[data[0] % 3];
    bool describes = data[0] & 0x40;
    if (data[0] & 0x80)
        one<Parameters>(data + 1, size - 1, format, describes);
    else
        one<Graph_Maker_make_Exception>(data + 1, size - 1, format, describes);
    return 0;
}
