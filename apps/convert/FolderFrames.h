// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "folder_layout.h"

namespace pointplane
{
struct FolderOptions
{
    std::string folder;
    std::string camera;          //!< preset or file; empty: what the folder tells
    double depthScale{0};        //!< units per metre; 0: the camera's or layout's
    double fps{0};               //!< 0: the layout's
    double maxDifference{0.02};  //!< between the stamps of colour and depth [s]
    bool evenStamps{false};      //!< evenStamps()
};

/** Which images of a folder are frames, and when they were taken. */
class FolderFrames
{
 public:
    struct Frame
    {
        ImageRef colour, depth;
        double stamp;       //!< [s]
        double depthDelay;  //!< stamp of depth minus that of colour [s]; NaN = not known
    };

    FolderFrames() = default;
    /** \throws InputError if no two images are a frame, or stamps cannot be right */
    FolderFrames(const FolderLayout& layout, const FolderOptions& options);

    [[nodiscard]] const std::vector<Frame>& all() const { return frames_; }
    /** In half a sentence, for people. */
    [[nodiscard]] std::string whatStampsAre() const;
    /** What was done to the stamps, and which images were left out. */
    [[nodiscard]] std::vector<std::string> notes() const;

 private:
    void pairImages(const FolderOptions& options);
    void checkNumbers(bool isRateAsked) const;
    void checkStamps() const;
    void leaveOutDoubles(std::vector<ImageRef>& images);
    void leaveOutUnlisted();
    void checkOrderOfList(bool mayRepeat) const;
    void evenOutStamps();
    void pairByStamp(double maxDifference);
    void pairByNumber();
    [[nodiscard]] double stampOf(const ImageRef& image) const;
    [[nodiscard]] std::vector<std::string> notesOfLeftOut() const;
    /** How far numbers are apart, if that is more than one, or empty. */
    [[nodiscard]] std::string noteOfSteps() const;

    std::string folder_;
    std::string stampList_;                  //!< FolderLayout::stampList
    std::vector<std::string> otherSources_;  //!< FolderLayout::otherSources
    std::vector<ImageRef> colour_, depth_;   //!< that may be of a frame
    // Left out: of a number or time that another image has; without a stamp in the layout's list.
    std::vector<ImageRef> doubles_, unlisted_;
    double fps_{30};
    bool hasStamps_{false};
    std::string evening_;  //!< what was done to the stamps, or empty
    std::vector<Frame> frames_;
};
}  // namespace pointplane
