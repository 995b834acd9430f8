// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace pointplane
{
/** Folder of a rawlog's external images that appears under its name when it is complete. Until then
 * it is `<name>.partial`, and an earlier folder with its name is untouched. All members throw
 * EnvironmentError naming the folder. */
class ImagesFolder
{
 public:
    /** Makes the partial folder, empty: what an earlier run left there goes. The folder that will
     * be replaced may hold images of ScanWriter only: nobody else's files are removed.
     * \param path its name in the end */
    explicit ImagesFolder(const std::string& path);

    /** Where images are written. */
    [[nodiscard]] const std::string& partialPath() const { return partial_; }

    /** Gives the folder its name; an earlier one gets the partial name. Done once more, it undoes
     * this. */
    void exchange();
    /** Removes what has the partial name: the earlier folder, or this one after a run that failed.
     */
    void removePartial() noexcept;

 private:
    std::string path_, partial_;
    bool isReplaced_{false};  //!< there is an earlier one
    bool isInPlace_{false};
};
}  // namespace pointplane
