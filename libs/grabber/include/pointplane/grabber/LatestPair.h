// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/grabber/CameraImage.h>

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>

namespace pointplane
{
/** Hands pairs from a producer that never waits to a consumer that may be slow. It holds one pair:
 * a newer one replaces it if it was not taken. */
class LatestPair
{
 public:
    void put(const ImagePair& pair)
    {
        {
            const std::lock_guard<std::mutex> lock(mutex_);
            numReplaced_ += pair_.has_value() ? 1 : 0;
            pair_ = pair;
        }
        changed_.notify_all();
    }

    /** Waits until the previous pair has been taken, for sources that can wait. */
    void putWhenTaken(const ImagePair& pair)
    {
        {
            std::unique_lock<std::mutex> lock(mutex_);
            changed_.wait(lock, [this] { return closed_ || !pair_.has_value(); });
            pair_ = pair;
        }
        changed_.notify_all();
    }

    /** Waits for a pair; nothing once closed and empty. */
    [[nodiscard]] std::optional<ImagePair> take()
    {
        std::optional<ImagePair> pair;
        {
            std::unique_lock<std::mutex> lock(mutex_);
            changed_.wait(lock, [this] { return closed_ || pair_.has_value(); });
            pair.swap(pair_);
        }
        changed_.notify_all();
        return pair;
    }

    void close()
    {
        {
            const std::lock_guard<std::mutex> lock(mutex_);
            closed_ = true;
        }
        changed_.notify_all();
    }

    [[nodiscard]] std::uint64_t numReplaced() const
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        return numReplaced_;
    }

 private:
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::optional<ImagePair> pair_;
    std::uint64_t numReplaced_{0};
    bool closed_{false};
};
}  // namespace pointplane
