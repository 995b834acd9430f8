// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

namespace pointplane
{
/** First in, first out between two threads; the producer waits when it is full. */
template <class T>
class BoundedQueue
{
 public:
    explicit BoundedQueue(std::size_t capacity) : capacity_(capacity) {}

    /** False if the queue has been closed: the value is dropped, the producer should stop. */
    bool push(T value)
    {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return closed_ || values_.size() < capacity_; });
        if (closed_)
        {
            return false;
        }
        values_.push_back(std::move(value));
        changed_.notify_all();
        return true;
    }

    /** Waits for a value; nothing once the queue is closed and empty. */
    [[nodiscard]] std::optional<T> pop()
    {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return closed_ || !values_.empty(); });
        if (values_.empty())
        {
            return {};
        }
        std::optional<T> value(std::move(values_.front()));
        values_.pop_front();
        changed_.notify_all();
        return value;
    }

    /** No more values come, or none are wanted; those inside can still be taken. */
    void close()
    {
        const std::lock_guard lock(mutex_);
        closed_ = true;
        changed_.notify_all();
    }

 private:
    std::size_t capacity_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<T> values_;
    bool closed_{false};
};
}  // namespace pointplane
