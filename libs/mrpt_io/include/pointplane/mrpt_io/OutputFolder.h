// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace pointplane
{
/** A folder that this program alone writes files into. All members throw EnvironmentError naming
 * the folder or file. */
class OutputFolder
{
 public:
    /** Makes it if need be. A folder that another program is writing into is refused. */
    explicit OutputFolder(const std::string& path);
    ~OutputFolder();
    OutputFolder(const OutputFolder&) = delete;
    OutputFolder& operator=(const OutputFolder&) = delete;

    /** Path for a file in it, before that is written. Nobody named that file, so a link with its
     * name makes way: what it leads to is not ours to write to. */
    [[nodiscard]] std::string fileAt(const std::string& name) const;

    /** Removes it if it was not there before and holds nothing, after a run that failed. */
    void removeIfNew() noexcept;

    [[nodiscard]] const std::string& path() const { return path_; }

 private:
    std::string path_;
    int fd_{-1};  //!< holds the lock
    bool isNew_{false};
};
}  // namespace pointplane
