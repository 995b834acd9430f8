// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "folder_layout.h"

namespace pointplane
{
/** The images of a folder that may be of a frame, and those that are left out before. Where there
 * are two of one number or time, like 7.png and 7.jpg, the first one is taken. */
class FolderImages
{
 public:
    FolderImages() = default;
    explicit FolderImages(const FolderLayout& layout);

    std::vector<ImageRef> colour, depth;

    [[nodiscard]] bool areStamped() const;
    [[nodiscard]] bool isDepthAlone() const { return colour.empty(); }

    /** Images of which FolderLayout::stampList tells nothing.
     * \throws InputError if it tells of none of colour, or of depth, where there are any */
    void leaveOutUnlisted();

    /** Names are in order of their stamps, a list need not be.
     * \param mayRepeat a stamp may be that of the image before \throws InputError */
    void checkOrderOfList(bool mayRepeat) const;

    /** Images that are in the folder and not in the rawlog, for people. */
    [[nodiscard]] std::vector<std::string> notesOfLeftOut(std::size_t numFrames) const;

 private:
    void leaveOutDoubles(std::vector<ImageRef>& images);

    std::string stampList_;                  //!< FolderLayout::stampList
    std::vector<std::string> otherSources_;  //!< FolderLayout::otherSources
    // Left out: of a number or time that another image has; without a stamp in the list.
    std::vector<ImageRef> doubles_, unlisted_;
};
}  // namespace pointplane
