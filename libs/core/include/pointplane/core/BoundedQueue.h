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
/** Queue between threads, first in, first out, that never holds more than `capacity` items. */
template <class T>
class BoundedQueue
{
 public:
    explicit BoundedQueue(std::size_t capacity) : capacity_(capacity) {}

    /** Never blocks. \return false when full or closed: the item is not taken */
    [[nodiscard]] bool tryPush(T item)
    {
        {
            const std::lock_guard<std::mutex> lock(mutex_);
            if (closed_ || items_.size() >= capacity_)
            {
                return false;
            }
            items_.push_back(std::move(item));
        }
        notEmpty_.notify_one();
        return true;
    }

    /** Waits for room. \return false when closed: the item is not taken */
    bool push(T item)
    {
        {
            std::unique_lock<std::mutex> lock(mutex_);
            notFull_.wait(lock, [this] { return closed_ || items_.size() < capacity_; });
            if (closed_)
            {
                return false;
            }
            items_.push_back(std::move(item));
        }
        notEmpty_.notify_one();
        return true;
    }

    /** Waits for an item. \return nothing when closed and empty */
    [[nodiscard]] std::optional<T> pop()
    {
        std::optional<T> item;
        {
            std::unique_lock<std::mutex> lock(mutex_);
            notEmpty_.wait(lock, [this] { return closed_ || !items_.empty(); });
            if (items_.empty())
            {
                return item;
            }
            item = std::move(items_.front());
            items_.pop_front();
        }
        notFull_.notify_one();
        return item;
    }

    /** Nothing goes in any more; what is inside can still be popped. */
    void close()
    {
        {
            const std::lock_guard<std::mutex> lock(mutex_);
            closed_ = true;
        }
        notEmpty_.notify_all();
        notFull_.notify_all();
    }

    [[nodiscard]] std::size_t size() const
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        return items_.size();
    }

    [[nodiscard]] std::size_t capacity() const { return capacity_; }

 private:
    const std::size_t capacity_;
    mutable std::mutex mutex_;
    std::condition_variable notEmpty_, notFull_;
    std::deque<T> items_;
    bool closed_{false};
};
}  // namespace pointplane
