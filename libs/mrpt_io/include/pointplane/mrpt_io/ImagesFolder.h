// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/mrpt_io/OutputFolder.h>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace pointplane
{
/** How a program tells images that it wrote from those of others. */
struct OwnImages
{
    std::string kind;  //!< "image of a rawlog"
    std::function<bool(const std::filesystem::path& file)> include;
};

/** Folder of images beside a rawlog that appears under its name when it is complete. Until then
 * it is `<name>.partial`, and an earlier folder with its name is untouched. All members throw
 * EnvironmentError naming the folder. */
class ImagesFolder
{
 public:
    /** Makes the partial folder, empty: what an earlier run left there goes. The folder that will
     * be replaced may hold own images only: nobody else's files are removed.
     * \param path its name in the end */
    ImagesFolder(const std::string& path, OwnImages own);

    /** Where images are written. */
    [[nodiscard]] const std::string& partialPath() const { return partial_; }

    /** Gives the folder its name, in place of an earlier one, and completes the rawlog. If that
     * throws, the earlier folder is back. */
    void completeWith(const std::function<void()>& completeRawlog);
    /** Removes the partial folder, after a run that failed. */
    void removePartial() noexcept;

 private:
    [[nodiscard]] std::vector<std::filesystem::path> imagesOf(const std::string& folder) const;
    void removeImages(const std::string& folder) const;
    /** Gives the folder its name; an earlier one gets the partial name. Done once more, it undoes
     * this. */
    void exchange();

    OwnImages own_;
    std::string path_, partial_;
    std::optional<OutputFolder> folder_;
    bool isReplaced_{false};  //!< there is an earlier one
    bool isInPlace_{false};
};
}  // namespace pointplane
