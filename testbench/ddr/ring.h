// SPDX-License-Identifier: MIT
//
// ring: a first-in first-out of fixed capacity (a power of two) without allocation.

#ifndef RING_H
#define RING_H

#include <cstddef>

template <class T, size_t capacity> class Ring {
    static_assert((capacity & (capacity - 1)) == 0, "a power of two");

public:
    bool empty() const { return head_ == tail_; }
    size_t size() const { return head_ - tail_; }
    bool full() const { return size() == capacity; }
    T& front() { return items_[tail_ % capacity]; }
    const T& front() const { return items_[tail_ % capacity]; }
    void push(const T& item) { items_[head_++ % capacity] = item; } // the user knows there is room
    void pop() { ++tail_; }

private:
    T items_[capacity];
    size_t head_ = 0, tail_ = 0;
};

#endif
