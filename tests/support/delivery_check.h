// SPDX-License-Identifier: MIT
//
// delivery_check: checks that the link keeps its promise for the messages from one program to
// another: each message arrives unchanged, at most once and in order, and each message that is
// reported as delivered has arrived.

#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

// Functions that return a string return an empty string if the link has kept its promise, otherwise
// an error text.
class DeliveryCheck {
public:
    using Bytes = std::vector<uint8_t>;

    // Records that a message is sent. The messages of one stream must arrive in the order of these
    // calls. `id` is the number of the message. It must differ from the numbers of all messages
    // that have not been reported yet.
    void sent(int stream, uint32_t id, const Bytes& message) {
        Stream& s = streams_[stream];
        s.messages.push_back({id, digestOf(message)});
        waiting_[id] = {stream, s.forgotten + s.messages.size() - 1};
        if (s.messages.size() > kept && !waiting_.count(s.messages.front().id)) {
            s.messages.pop_front();
            ++s.forgotten;
        }
    }

    // Checks a message that arrived at a receiver. If several receivers share an address, each of
    // them gets its messages in order, and a message arrives at only one of them.
    std::string arrived(int stream, const Bytes& message, int receiver = 0) {
        Stream& s = streams_[stream];
        const uint64_t digest = digestOf(message);
        const size_t next = s.nextOf(receiver), end = s.messages.size();
        for (size_t at = next; at < end; ++at)
            if (s.messages[at].digest == digest && !s.messages[at].hasArrived)
                return take(s, at, receiver);
        for (size_t at = 0; at < end; ++at)
            if (s.messages[at].digest == digest)
                return s.fault(at,
                               s.messages[at].hasArrived ? "is a duplicate" : "is out of order");
        return "a message is wrong";
    }
    // Checks a message that contains its number.
    std::string arrived(int stream, uint32_t id, const Bytes& message, int receiver = 0) {
        Stream& s = streams_[stream];
        size_t at = s.messages.size();
        while (at && s.messages[at - 1].id != id)
            --at;
        if (!at)
            return "message " + std::to_string(id) + " was never sent";
        if (s.messages[--at].digest != digestOf(message))
            return s.fault(at, "is wrong");
        if (s.messages[at].hasArrived)
            return s.fault(at, "is a duplicate");
        if (at < s.nextOf(receiver))
            return s.fault(at, "is out of order");
        return take(s, at, receiver);
    }

    // Checks a report to the sender. The report is that the message was delivered, or that its
    // outcome is unknown.
    std::string reported(uint32_t id, bool isDelivered) {
        const auto found = waiting_.find(id);
        if (found == waiting_.end())
            return "message " + std::to_string(id) + " was reported twice, or never sent";
        const auto [stream, number] = found->second;
        waiting_.erase(found);
        Stream& s = streams_[stream];
        const size_t at = number - s.forgotten;
        return isDelivered && !s.messages[at].hasArrived
                   ? s.fault(at, "was reported delivered, but has not arrived")
                   : "";
    }
    // Expects no further reports for the messages of a stream, because their sender has restarted.
    // Returns the number of messages without a report.
    size_t forget(int stream) {
        size_t count = 0;
        for (auto it = waiting_.begin(); it != waiting_.end();) {
            const bool is = it->second.first == stream;
            count += is;
            it = is ? waiting_.erase(it) : std::next(it);
        }
        return count;
    }

    uint64_t arrivals() const { return arrivals_; }
    // Returns true if all messages have been reported.
    bool isQuiet() const { return waiting_.empty(); }

private:
    static constexpr size_t kept = 10'000; // number of messages of a stream that are stored

    struct Message {
        uint32_t id;
        uint64_t digest;
        bool hasArrived = false;
    };
    struct Stream {
        std::deque<Message> messages;
        size_t forgotten = 0; // number of older messages that are no longer stored
        // number of the first message that may arrive next, for each receiver
        std::map<int, size_t> next;

        size_t nextOf(int receiver) {
            const size_t number = next[receiver];
            return number > forgotten ? number - forgotten : 0;
        }
        std::string fault(size_t at, const char* what) const {
            return "message " + std::to_string(messages[at].id) + " " + what;
        }
    };

    // Returns a hash of the message (FNV-1a, 64 bits).
    static uint64_t digestOf(const Bytes& message) {
        uint64_t digest = 0xCBF29CE484222325u ^ message.size();
        for (uint8_t byte : message)
            digest = (digest ^ byte) * 0x100000001B3u;
        return digest;
    }
    // Records that a message arrived. It is an error to skip an earlier message that has neither
    // arrived nor been reported to the sender.
    std::string take(Stream& s, size_t at, int receiver) {
        s.messages[at].hasArrived = true;
        ++arrivals_;
        for (size_t skipped = s.nextOf(receiver); skipped < at; ++skipped)
            if (waiting_.count(s.messages[skipped].id) && !s.messages[skipped].hasArrived)
                return s.fault(skipped, "was skipped");
        s.next[receiver] = s.forgotten + at + 1;
        return "";
    }

    std::map<int, Stream> streams_;
    // messages without a report: stream and number of each
    std::unordered_map<uint32_t, std::pair<int, size_t>> waiting_;
    uint64_t arrivals_ = 0;
};
