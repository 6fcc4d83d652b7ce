// SPDX-License-Identifier: MIT
//
// ast: the declarations of a Slice file and of the files that it includes. The parser creates them,
// with every name resolved and Slice's rules checked; the generators read them.
//
// Unit         declarations in source order, including declarations of included files
//   Declaration  one enum, struct, sequence, dictionary, interface, class, exception or constant
//   Operation    of an interface;  Field: a member or a parameter;  Type: of a field

#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <ostream>
#include <set>
#include <string>
#include <string_view>
#include <vector>

// Position in a source, for errors and warnings.
struct Location {
    std::string_view file;    // file name, stored by Diagnostics::intern
    int line = 0, column = 0; // line and column, both starting at 1
};

class Diagnostics {
public:
    // Categories of warnings, with the names used in `[["suppress-warning:..."]]`.
    enum Category { General, Deprecated, Metadata };

    explicit Diagnostics(std::ostream& out) : out_(out) {}
    Diagnostics(const Diagnostics&) = delete;
    Diagnostics& operator=(const Diagnostics&) = delete;

    void error(const Location& at, const std::string& text);
    void warning(const Location& at, const std::string& text, Category category = General);
    // Suppresses warnings of this category (General: of all categories) for the current file.
    void suppress(std::string_view file, Category category) {
        suppressed_.insert({file, category});
    }

    int errors() const { return errors_; }
    // Copies the text; the copy lives as long as this object.
    std::string_view intern(std::string_view text);

private:
    void print(const Location& at, const char* kind, const std::string& text);
    const std::vector<std::string>& lines(std::string_view file);

    std::ostream& out_;
    int errors_ = 0;
    std::set<std::string, std::less<>> names_;
    std::set<std::pair<std::string_view, Category>> suppressed_;
    std::map<std::string_view, std::vector<std::string>> files_;
};

struct Declaration;

struct Type {
    enum class Kind {
        Void,
        Bool,
        Byte,
        Short,
        Int,
        Long,
        Float,
        Double,
        String,
        Named, // type defined by `declaration`: enum, struct, sequence, dictionary or class
        Proxy, // proxy to the interface `declaration`; 0 means Object*
        // instance of a class: Object, Value (any class), or, if `declaration` is set, an interface
        // passed by value
        Value,
        LocalObject // local object; allowed in local definitions only
    };
    Kind kind = Kind::Void;
    Declaration* declaration = nullptr;
};

// The value of a constant, or of a member's default.
struct Literal {
    enum class Kind { None, Bool, Integer, Floating, String, Enumerator };
    Kind kind = Kind::None;
    int64_t integer = 0; // value of a Bool, an Integer or an Enumerator
    double floating = 0; // value of a Floating
    // Floating: its text as written; String: its text in UTF-8; Enumerator: its name
    std::string text;
    const Declaration* owner = nullptr; // Enumerator: the enum that contains it
};

struct Field {
    Type type;
    std::string name, doc;
    Location at;
    bool isOut = false; // out parameter of an operation
    bool isOptional = false;
    int tag = 0;   // tag of an optional field
    Literal value; // default value of a member
    std::vector<std::string> metadata;
};

struct Operation {
    std::string name, doc;
    Type result; // Void if the operation returns nothing
    bool isResultOptional = false;
    int resultTag = 0;
    // parameters in the order of the source, in parameters before out parameters
    std::vector<Field> parameters;
    std::vector<const Declaration*> throws;
    bool idempotent = false;
    Location at;
    std::vector<std::string> metadata;
};

struct Enumerator {
    std::string name, doc;
    int64_t value = 0;
    Location at;
};

struct Declaration {
    enum class Kind { Enum, Struct, Sequence, Dictionary, Interface, Class, Exception, Constant };
    Kind kind = Kind::Enum;
    std::string name, doc;
    std::vector<std::string> scope; // enclosing modules, outermost first
    Location at;
    bool fromInclude = false;
    bool isLocal = false;
    bool isForward = false; // an interface or class with only a forward declaration
    std::vector<std::string> metadata;

    std::vector<Enumerator> enumerators; // Enum
    bool hasValues = false;              // Enum: true if an enumerator has an explicit value
    // Struct, Class, Exception: members, without inherited ones
    std::vector<Field> fields;
    // Dictionary: types of key and element; Sequence: type of the elements; Constant: its type
    Type key, element;
    Literal value; // Constant
    // bases; an Interface has any number, a Class or Exception at most one
    std::vector<const Declaration*> bases;
    std::vector<const Declaration*> implemented; // Class: interfaces that it implements
    // Interface, Class: operations without inherited ones
    std::vector<Operation> operations;
    // class from which this interface was generated; null for other declarations
    const Declaration* ofClass = nullptr;
    int compactId = -1; // Class: compact id; -1 if none

    // Properties of the type's values; set when the definition of the type is complete.
    struct Facts {
        int leastWireSize = 1;  // bytes
        bool isVariable = true; // true if the encoded size varies
        bool hasClass = false;  // true if a class is contained, at any depth
        bool isKey = false;     // true if the type can be the key of a dictionary
        bool hasSequence = false;
        // true if the type contains only numbers, enums, structs and sequences
        bool isNumeric = true;
    } facts;
    void complete();

    std::string id() const; // returns ::Module::Sub::Name
    // Returns whether this declaration is `other` or derives from it.
    bool isA(const Declaration& other) const;
    // Returns whether slices of unknown derived types are preserved: ["preserve-slice"] is set here
    // or on a base.
    bool preserves() const;
    const Declaration* base() const { return bases.empty() ? nullptr : bases.front(); }
};

struct Unit {
    std::string file; // main file, as named on the command line
    std::vector<std::unique_ptr<Declaration>> declarations;
    std::vector<std::string> metadata; // file metadata [["..."]] of the main file
};

Declaration::Facts factsOf(const Type& type);
// Returns whether the directive is present.
bool hasMetadata(const std::vector<std::string>& metadata, const std::string& directive);
// Returns the text after "prefix:" in a directive; an empty string if no such directive exists.
std::string metadataValue(const std::vector<std::string>& metadata, const std::string& prefix);
