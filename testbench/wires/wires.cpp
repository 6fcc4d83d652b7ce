// SPDX-License-Identifier: MIT
//
// wires: computes the levels of nets from their drivers and pulls.

#include "wires.h"
#include <algorithm>
#include <stdexcept>

Wires::Wires(std::vector<std::string> names)
    : names_(std::move(names)), nodes_(names_.size()), nodeOf_(2 * names_.size()),
      inverted_(2 * names_.size()), ringing_(names_.size()), ends_(2 * names_.size()),
      others_(names_.size(), None) {
    for (unsigned i = 0; i < nodeOf_.size(); ++i)
        nodeOf_[i] = i / 2;
}

unsigned Wires::net(const std::string& name) const {
    const auto found = std::find(names_.begin(), names_.end(), name);
    if (found == names_.end())
        throw std::runtime_error("wire " + name + ": no such net on this board");
    return static_cast<unsigned>(found - names_.begin());
}

unsigned Wires::newNode() {
    nodes_.emplace_back();
    return static_cast<unsigned>(nodes_.size() - 1);
}

void Wires::plant(const WireFault& fault) {
    if (fault.kind == WireFault::Shifted && fault.wire == "A")
        return shiftAddress();
    const unsigned a = net(fault.wire), b = fault.other.empty() ? a : net(fault.other);
    dirty_ = true;
    switch (fault.kind) {
    case WireFault::Open:
        nodeOf_[2 * a] = newNode();
        break;
    case WireFault::Stuck0:
    case WireFault::Stuck1:
        nodes_[nodeOf_[2 * a]].fixed = true;
        nodes_[nodeOf_[2 * a]].fixedLevel = fault.kind == WireFault::Stuck1;
        break;
    case WireFault::Pull0:
    case WireFault::Pull1:
        nodes_[nodeOf_[2 * a]].otherPull = fault.kind == WireFault::Pull1 ? High : Low;
        break;
    case WireFault::Short:
        std::replace(nodeOf_.begin(), nodeOf_.end(), unsigned(nodeOf_[2 * b]),
                     unsigned(nodeOf_[2 * a]));
        break;
    case WireFault::Swapped:
        std::swap(nodeOf_[2 * a], nodeOf_[2 * b]);
        break;
    case WireFault::Inverted:
        inverted_[2 * a] = true;
        break;
    case WireFault::Ringing:
        ringing_[a] = true;
        break;
    default:
        throw std::runtime_error("wire " + fault.wire +
                                 ": expected a fault that changes the level of a wire");
    }
}

// Joins end 0 of each address line with end 1 of the line with the next number.
void Wires::shiftAddress() {
    constexpr unsigned count = 25;
    for (unsigned line = count; line-- > 0;) {
        const unsigned a = net("A" + std::to_string(line));
        nodeOf_[2 * a] =
            line + 1 < count ? nodeOf_[2 * net("A" + std::to_string(line + 1)) + 1] : newNode();
    }
    dirty_ = true;
}

void Wires::powerOff(unsigned net) {
    nodeOf_[2 * net] = newNode();
    Node& node = nodes_[nodeOf_[2 * net + 1]];
    node.fixed = true;
    node.fixedLevel = false;
    dirty_ = true;
}

void Wires::set(unsigned net, unsigned end, End what, uint64_t now) {
    End& e = ends_[2 * net + end];
    if (e == what)
        return;
    settle(now);
    e = what;
    dirty_ = true;
}

void Wires::setOther(unsigned net, Level driver, uint64_t now) {
    if (others_[net] == driver)
        return;
    settle(now);
    others_[net] = driver;
    dirty_ = true;
}

// Computes the levels of all nodes if a driver has changed or a delay has ended.
void Wires::settle(uint64_t now) {
    if (!dirty_ && now < due_)
        return;
    dirty_ = false;
    due_ = ~0ull;
    drive_.assign(nodes_.size(), None);
    pull_.assign(nodes_.size(), None);
    fight_.assign(nodes_.size(), false);
    // Combines a driver with the drivers of a node: low wins against high.
    auto combine = [this](unsigned node, Level level) {
        if (level == None)
            return;
        fight_[node] = fight_[node] || (drive_[node] != None && drive_[node] != level);
        drive_[node] = drive_[node] == Low ? int8_t(Low) : int8_t(level);
    };
    for (unsigned i = 0; i < ends_.size(); ++i) {
        const unsigned node = nodeOf_[i];
        // An end behind an inverter does not drive the node, because the inverter passes the signal
        // only towards this end.
        const bool passes = !inverted_[i];
        if (passes)
            combine(node, ends_[i].driver);
        if (i % 2 == 0 && passes)
            combine(node, others_[i / 2]);
        if (ends_[i].pull != None && passes && (i % 2 == 1 || pull_[node] == None))
            pull_[node] = ends_[i].pull; // the FPGA's pull is stronger than the pull at end 0
    }
    for (unsigned n = 0; n < nodes_.size(); ++n) {
        Node& node = nodes_[n];
        if (node.otherPull != None)
            pull_[n] = node.otherPull;
        if (node.fixed)
            drive_[n] = node.fixedLevel;
        if (fight_[n] && !node.fighting)
            ++fights_;
        node.fighting = fight_[n];
        const bool pulls = drive_[n] == None && pull_[n] != None && pull_[n] != node.level;
        if (drive_[n] != None)
            node.level = drive_[n];
        if (!pulls) {
            node.moving = false;
        } else if (!node.moving) {
            node.moving = true;
            node.since = now;
        }
        if (node.moving && now >= node.since + pullNs) {
            node.level = pull_[n];
            node.moving = false;
        }
        if (node.moving)
            due_ = std::min(due_, node.since + pullNs);
    }
}
