// SPDX-License-Identifier: MIT
//
// ice_messages: builds IceP messages byte by byte, as the manual of ZeroC Ice 3.7 describes them.

#pragma once

#include "ice_header.h"
#include <cstdint>
#include <string>
#include <vector>

namespace IceMessages {

using Bytes = std::vector<uint8_t>;

inline void put32(Bytes& m, uint32_t value) {
    for (int i = 0; i < 4; ++i)
        m.push_back(static_cast<uint8_t>(value >> 8 * i));
}

inline void append(Bytes& m, const Bytes& more) {
    m.insert(m.end(), more.begin(), more.end());
}

// Returns a message with its header.
inline Bytes message(uint8_t type, const Bytes& body, uint8_t compression = 0) {
    return IceHeader::pack(type, body, compression);
}

inline void encapsulate(Bytes& m, const Bytes& parameters, uint8_t minor = 1) {
    put32(m, static_cast<uint32_t>(parameters.size()) + 6);
    m.push_back(1);
    m.push_back(minor);
    append(m, parameters);
}

inline void putString(Bytes& m, const std::string& s) {
    m.push_back(static_cast<uint8_t>(s.size()));
    m.insert(m.end(), s.begin(), s.end());
}

// Returns the body of a request; the body starts with the identity of the object.
inline Bytes requestBody(const std::string& object, const std::string& operation, uint8_t minor = 1,
                         const Bytes& parameters = {}, const std::string& facet = "",
                         uint8_t mode = 0) {
    Bytes m;
    putString(m, object);
    putString(m, ""); // category
    m.push_back(facet.empty() ? 0 : 1);
    if (!facet.empty())
        putString(m, facet);
    putString(m, operation);
    m.push_back(mode);
    m.push_back(0); // context
    encapsulate(m, parameters, minor);
    return m;
}

inline Bytes request(uint32_t id, const Bytes& body) {
    Bytes m;
    put32(m, id);
    append(m, body);
    return message(IceHeader::Request, m);
}

// Returns a complete request; with id 0, the request is one-way.
inline Bytes request(uint32_t id, const std::string& object, const std::string& operation,
                     const Bytes& parameters, const std::string& facet = "", uint8_t minor = 1) {
    return request(id, requestBody(object, operation, minor, parameters, facet));
}

inline Bytes reply(uint32_t id, const Bytes& results, uint8_t status = 0, uint8_t minor = 1) {
    Bytes m;
    put32(m, id);
    m.push_back(status);
    encapsulate(m, results, minor);
    return message(IceHeader::Reply, m);
}

inline Bytes validate() {
    return message(IceHeader::Validate, {});
}
inline Bytes closing() {
    return message(IceHeader::CloseConnection, {}, 1);
}

} // namespace IceMessages
