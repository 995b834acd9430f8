// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "Recording.h"
#include "folder_layout.h"

namespace pointplane
{
class VideoFrames;

struct FolderOptions
{
    std::string folder;
    std::string camera;          //!< preset or file; empty: what the folder tells
    double depthScale{0};        //!< units per metre; 0: the camera's or layout's
    double fps{0};               //!< 0: the layout's
    double maxDifference{0.02};  //!< between the stamps of colour and depth [s]
    bool evenStamps{false};      //!< evenStamps()
};

/** A folder of numbered or stamped images. Depth of another size than colour is taken as seen by a
 * camera of its own in the same place. */
class FolderRecording : public Recording
{
 public:
    /** \throws InputError */
    explicit FolderRecording(const FolderOptions& options);
    ~FolderRecording() override;

    [[nodiscard]] std::optional<RecordedFrame> next() override;
    [[nodiscard]] double progress() const override;
    [[nodiscard]] std::vector<std::string> notes() const override;

 private:
    void chooseCamera(const FolderOptions& options);
    void pairImages(const FolderOptions& options);
    void checkNumbers(bool isRateAsked) const;
    void checkStamps() const;
    void leaveOutDoubles(std::vector<ImageRef>& images);
    void leaveOutUnlisted();
    void checkOrderOfList() const;
    void evenOutStamps();
    void pairByStamp(double maxDifference);
    void pairByNumber();
    [[nodiscard]] double stampOf(const ImageRef& image) const;
    [[nodiscard]] cv::Mat colourOf(const ImageRef& image);
    void readDepth(const ImageRef& image, RegisteredScan& scan);
    [[nodiscard]] std::vector<std::string> notesOfLeftOut() const;
    /** How far numbers are apart, if that is more than one, or empty. */
    [[nodiscard]] std::string noteOfSteps() const;

    std::string folder_;
    FolderLayout layout_;
    double unitsPerMetre_{1000}, fps_{30};
    double floatUnits_{1};  //!< the same, of depth in floating point
    bool isFloat_{false};   //!< depth has been
    bool hasStamps_{false};
    // Left out: of a number or time that another image has; without a stamp in the layout's list.
    std::vector<ImageRef> doubles_, unlisted_;
    std::string evening_;  //!< what was done to the stamps, or empty
    std::vector<std::pair<std::size_t, std::size_t>> pairs_;
    std::size_t next_{0};
    std::unique_ptr<VideoFrames> video_;
};
}  // namespace pointplane
