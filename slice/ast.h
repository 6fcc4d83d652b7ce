// SPDX-License-Identifier: MIT
//
// ast: what a Slice file declares.

#ifndef AST_H
#define AST_H

#include "diagnostics.h"
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

struct Declaration;

struct Type {
    enum class Kind { Void, Bool, Byte, Short, Int, Long, Float, Double, String, Named, Proxy };
    Kind kind = Kind::Void;
    Declaration* declaration = nullptr; // Named: enum, struct, sequence; Proxy: interface, 0 for Object*
};

struct Field {
    Type type;
    std::string name, doc;
    Location at;
    bool isOut = false; // of an operation's parameter
};

struct Operation {
    std::string name, doc;
    Type result;
    std::vector<Field> parameters;
    bool idempotent = false;
    Location at;
};

struct Enumerator {
    std::string name;
    int64_t value = 0;
};

struct Declaration {
    enum class Kind { Enum, Struct, Sequence, Interface, Constant };
    Kind kind = Kind::Enum;
    std::string name, doc;
    std::vector<std::string> scope; // modules
    Location at;
    bool fromInclude = false;
    bool isForward = false; // an interface that is declared, not defined
    std::vector<std::string> metadata;
    std::vector<Enumerator> enumerators;
    std::vector<Field> fields;
    Type element; // of a sequence; type of a constant
    std::string value; // of a constant
    std::vector<Declaration*> bases;
    std::vector<Operation> operations;

    std::string cName() const {
        std::string s;
        for (const std::string& module : scope)
            s += module + "_";
        return s + name;
    }
    std::string id() const {
        std::string s;
        for (const std::string& module : scope)
            s += "::" + module;
        return s + "::" + name;
    }
    bool isHardware() const {
        for (const std::string& m : metadata)
            if (m == ":hw")
                return true;
        return false;
    }
};

struct Unit {
    std::vector<std::unique_ptr<Declaration>> declarations; // in the order of the source
};

#endif
