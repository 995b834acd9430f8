// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "FolderImages.h"

namespace pointplane
{
struct FolderOptions
{
    std::string folder;
    std::string camera;          //!< preset or file; empty: what the folder tells
    double depthScale{0};        //!< units per metre; 0: the camera's or layout's
    double fps{0};               //!< 0: the layout's
    double maxDifference{0.02};  //!< between the stamps of colour and depth [s]
    bool evenStamps{false};      //!< moves stamps by evenStamps()
};

/** Which images of a folder are frames, and when they were taken. */
class FolderFrames
{
 public:
    struct Frame
    {
        ImageRef colour, depth;  //!< of depth alone, colour has no path
        double stamp;            //!< [s]
        double depthDelay;       //!< stamp of depth minus that of colour [s]; NaN = not known
    };

    FolderFrames() = default;
    /** \throws InputError if no two images are a frame, or stamps cannot be right */
    FolderFrames(const FolderLayout& layout, const FolderOptions& options);

    [[nodiscard]] const std::vector<Frame>& all() const { return frames_; }
    [[nodiscard]] bool areDepthAlone() const { return images_.isDepthAlone(); }
    /** In half a sentence, for people. */
    [[nodiscard]] std::string whatStampsAre() const;
    /** What was done to the stamps, and which images were left out. */
    [[nodiscard]] std::vector<std::string> notes() const;

 private:
    void pairImages(const FolderOptions& options);
    void checkLists() const;
    void checkNumbers(bool isRateAsked) const;
    void checkStamps() const;
    void evenOutStamps();
    void pairByStamp(double maxDifference);
    void pairByNumber();
    void takeDepthAlone();
    [[nodiscard]] double stampOf(const ImageRef& image) const;
    /** How far numbers are apart, if that is more than one, or empty. */
    [[nodiscard]] std::string noteOfSteps() const;

    std::string folder_;
    FolderImages images_;
    double fps_{30};
    bool hasStamps_{false};
    std::string evening_;  //!< what was done to the stamps, or empty
    std::vector<Frame> frames_;
};
}  // namespace pointplane
