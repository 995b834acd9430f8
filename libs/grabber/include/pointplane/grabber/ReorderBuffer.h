// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

namespace pointplane
{
/** Puts the results of parallel workers back into the order of their numbers 0, 1, 2, ...
 * A worker that is more than `capacity` ahead of the reader waits. */
template <class T>
class ReorderBuffer
{
 public:
    explicit ReorderBuffer(std::size_t capacity) : capacity_(capacity) {}

    /** Waits while `number` is too far ahead. Every number must be put exactly once. */
    void put(std::uint64_t number, T item)
    {
        {
            std::unique_lock<std::mutex> lock(mutex_);
            roomOrClosed_.wait(lock, [&] { return closed_ || number < next_ + capacity_; });
            items_.emplace(number, std::move(item));
        }
        available_.notify_one();
    }

    /** The item with the next number, or nothing when it did not come in time or will not come
     * (isFinished()). */
    [[nodiscard]] std::optional<T> takeFor(std::chrono::milliseconds timeout)
    {
        std::optional<T> item;
        {
            std::unique_lock<std::mutex> lock(mutex_);
            available_.wait_for(lock, timeout, [this] { return closed_ || nextIsHere(); });
            if (!nextIsHere())
            {
                return item;
            }
            item = std::move(items_.begin()->second);
            items_.erase(items_.begin());
            ++next_;
        }
        roomOrClosed_.notify_all();
        return item;
    }

    /** All workers are done. */
    void close()
    {
        {
            const std::lock_guard<std::mutex> lock(mutex_);
            closed_ = true;
        }
        available_.notify_all();
        roomOrClosed_.notify_all();
    }

    [[nodiscard]] bool isFinished() const
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        return closed_ && !nextIsHere();
    }

 private:
    bool nextIsHere() const { return !items_.empty() && items_.begin()->first == next_; }

    const std::size_t capacity_;
    mutable std::mutex mutex_;
    std::condition_variable available_, roomOrClosed_;
    std::map<std::uint64_t, T> items_;
    std::uint64_t next_{0};
    bool closed_{false};
};
}  // namespace pointplane
