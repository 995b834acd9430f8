// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/grabber/LatestPair.h>

#include <atomic>
#include <string>
#include <thread>

namespace pointplane
{
/** Keeps a PNG file of the latest pair fresh, at most once a second, in a thread of low priority.
 * Viewers never see half a picture. */
class Preview
{
 public:
    /** \throws EnvironmentError if the file cannot be written */
    explicit Preview(std::string path);
    ~Preview();
    Preview(const Preview&) = delete;
    Preview& operator=(const Preview&) = delete;

    void show(const ImagePair& pair) { latest_.put(pair); }

    /** Writes the latest pair. \return why a picture could not be written, or nothing */
    [[nodiscard]] std::string finish();

 private:
    void work();

    std::string path_;
    LatestPair latest_;
    std::string problem_;  // of the thread, until it has ended
    std::atomic<bool> stop_{false};
    std::thread thread_;
};
}  // namespace pointplane
