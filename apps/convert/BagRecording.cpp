// SPDX-License-Identifier: BSD-3-Clause
#include "BagRecording.h"

#include <pointplane/core/counted.h>
#include <pointplane/evaluation/association.h>
#include <pointplane/mrpt_io/mrpt_poses.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <numeric>

#include "bag_cameras.h"
#include "bag_topics.h"
#include "frame_images.h"
#include "ros_images.h"
#include "stamp_check.h"

namespace pointplane
{
namespace
{
using sensor_msgs::CompressedImage;
using sensor_msgs::Image;

/** Stamp of a message's header, and its picture. */
struct Picture
{
    double stamp{0};
    cv::Mat image;
};

/** \return what `read` makes of the message \throws BadFrame if it is no image */
template <class Read>
[[nodiscard]] auto readImage(const rosbag::MessageInstance& message, const Read& read)
{
    if (const auto image = message.instantiate<Image>())
    {
        return read(*image);
    }
    if (const auto image = message.instantiate<CompressedImage>())
    {
        return read(*image);
    }
    throw BadFrame("is not an image");
}

[[nodiscard]] double readStamp(const rosbag::MessageInstance& message)
{
    return readImage(message, [](const auto& image) { return image.header.stamp.toSec(); });
}

[[nodiscard]] Picture readPicture(const rosbag::MessageInstance& message)
{
    return readImage(
        message,
        [](const auto& image) {
            return Picture{image.header.stamp.toSec(), toMat(image)};
        });
}

using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

/** Numbers of messages by stamp: a bag has them in the order in which they arrived. */
[[nodiscard]] std::vector<std::size_t> orderOf(const std::vector<double>& stamps)
{
    std::vector<std::size_t> out(stamps.size());
    std::iota(out.begin(), out.end(), std::size_t{0});
    std::stable_sort(
        out.begin(),
        out.end(),
        [&](std::size_t a, std::size_t b) { return stamps[a] < stamps[b]; });
    return out;
}

/** associate() of stamps in any order. */
[[nodiscard]] Pairs pairsOf(std::vector<double> colour, std::vector<double> depth, double longest)
{
    const std::vector<std::size_t> colourOrder = orderOf(colour), depthOrder = orderOf(depth);
    std::sort(colour.begin(), colour.end());
    std::sort(depth.begin(), depth.end());
    Pairs out = associate(colour, depth, 0.0, longest);
    for (auto& [c, d] : out)
    {
        c = colourOrder[c];
        d = depthOrder[d];
    }
    return out;
}

/** "320x240 of 8 bit and 3 channels" */
[[nodiscard]] std::string describe(const cv::Mat& image)
{
    return sizeText(image.size()) + " of " + typeText(image);
}

class BagRecording : public Recording
{
 public:
    explicit BagRecording(const BagOptions& options) : options_(options)
    {
        std::error_code error;
        if (!std::filesystem::is_regular_file(options.file, error))
        {
            throw InputError("cannot open " + options.file + ": " + whyNoFile(options.file));
        }
        try
        {
            bag_.open(options.file, rosbag::bagmode::Read);
            chooseTopics();
            cameras_ = readBagCameras(bag_, colour_, depth_, options);
            std::copy_if(
                cameras_.notes.begin(),
                cameras_.notes.end(),
                std::back_inserter(notes_),
                [](const std::string& note) { return !note.empty(); });
            pair();
        }
        catch (const rosbag::BagUnindexedException&)
        {
            throw InputError(
                options.file +
                ": has no index, as its recording was broken off; run rosbag reindex");
        }
        catch (const ros::Exception& e)
        {
            throw InputError(
                options.file + ": is not a whole ROS 1 bag: " + e.what() +
                "; if its recording was broken off, run rosbag reindex");
        }
        view_ = std::make_unique<rosbag::View>(
            bag_, rosbag::TopicQuery(std::vector<std::string>{colour_.name, depth_.name}));
        at_ = view_->begin();
    }

    [[nodiscard]] std::optional<RecordedFrame> next() override;

    [[nodiscard]] double progress() const override
    {
        return static_cast<double>(numRead_) / std::max(1U, view_->size());
    }

    [[nodiscard]] std::string damage() const override { return damage_; }
    [[nodiscard]] std::vector<std::string> notes() const override { return notes_; }

 private:
    void chooseTopics();
    void pair();
    [[nodiscard]] std::optional<RecordedFrame> take(const rosbag::MessageInstance& message);
    [[nodiscard]] RecordedFrame frame(const Picture& colour, const Picture& depth) const;
    void noteDamage(std::size_t numRead, const ros::Exception& e);

    BagOptions options_;
    rosbag::Bag bag_;
    ImageTopic colour_, depth_;
    BagCameras cameras_;
    std::map<std::pair<bool, std::uint32_t>, std::uint32_t> partner_;  //!< by (isDepth, number)
    std::map<std::pair<bool, std::uint32_t>, std::optional<Picture>> waiting_;
    std::unique_ptr<rosbag::View> view_;
    rosbag::View::iterator at_;
    std::uint32_t numRead_{0}, numColour_{0}, numDepth_{0};
    std::string damage_;
    std::vector<std::string> notes_;
};

void BagRecording::chooseTopics()
{
    const std::vector<ImageTopic> topics = imageTopics(bag_);
    colour_ = chosenTopic(topics, options_.colourTopic, ImageKind::Colour, options_.file);
    depth_ = chosenTopic(topics, options_.depthTopic, ImageKind::Depth, options_.file);
    notes_.push_back(
        "colour: " + colour_.name + " (" + colour_.encoding + "), depth: " + depth_.name + " (" +
        depth_.encoding + ")");
}

void BagRecording::noteDamage(std::size_t numRead, const ros::Exception& e)
{
    if (damage_.empty())
    {
        damage_ = options_.file + ": damaged after message " + std::to_string(numRead) +
                  " of its images: " + e.what();
    }
}

void BagRecording::pair()
{
    std::vector<double> colour, depth;
    rosbag::View view(
        bag_, rosbag::TopicQuery(std::vector<std::string>{colour_.name, depth_.name}));
    try
    {
        for (const rosbag::MessageInstance& message : view)
        {
            const double stamp = readStamp(message);
            (message.getTopic() == depth_.name ? depth : colour).push_back(stamp);
        }
    }
    catch (const ros::Exception& e)
    {
        // Read again, the library may go on as if nothing were wrong.
        noteDamage(colour.size() + depth.size(), e);
    }
    requireTimes(colour, options_.file + ": " + colour_.name);
    requireTimes(depth, options_.file + ": " + depth_.name);
    for (const auto& [c, d] : pairsOf(colour, depth, options_.maxDifference))
    {
        partner_[{false, static_cast<std::uint32_t>(c)}] = static_cast<std::uint32_t>(d);
        partner_[{true, static_cast<std::uint32_t>(d)}] = static_cast<std::uint32_t>(c);
    }
    if (partner_.empty())
    {
        throw InputError(
            options_.file + ": no colour and depth stamps within " +
            std::to_string(options_.maxDifference) + " s of each other");
    }
    const std::size_t alone = colour.size() + depth.size() - partner_.size();
    if (alone > 0)
    {
        notes_.push_back("left out, without a partner: " + counted(alone, "image"));
    }
}

RecordedFrame BagRecording::frame(const Picture& colour, const Picture& depth) const
{
    RecordedFrame out;
    out.depthDelay = depth.stamp - colour.stamp;
    RegisteredScan& scan = out.scan;
    scan.stamp = fromSeconds(colour.stamp);
    scan.camera = cameras_.colour;
    scan.depthCamera = cameras_.depth;
    scan.colour = colour.image;
    scan.depth = depth.image;
    scan.unitsPerMetre = cameras_.unitsPerMetre;
    if (scan.depth.type() == CV_32FC1)
    {
        setFloatDepth(out, depth.image, options_.depthScale);
    }
    const cv::Size ofCamera(scan.camera.width, scan.camera.height);
    if (!scan.depthCamera && scan.colour.size() == ofCamera && scan.depth.size() != ofCamera)
    {
        setCameraOfRegisteredDepth(scan, "");
    }
    const PinholeCamera& ofDepth = scan.depthCamera ? scan.depthCamera->camera : scan.camera;
    if (scan.colour.size() != ofCamera ||
        scan.depth.size() != cv::Size(ofDepth.width, ofDepth.height) ||
        scan.depth.type() != CV_16UC1 || scan.colour.depth() != CV_8U)
    {
        throw BadFrame(
            "colour is " + describe(scan.colour) + ", depth " + describe(scan.depth) +
            "; expected are colour of 8 bit and " + sizeText(ofCamera) + ", depth of 16 bit and " +
            sizeText({ofDepth.width, ofDepth.height}) + ", as the calibration says");
    }
    if (const std::string problem = ofDepth.problem(); !problem.empty())
    {
        throw BadFrame("camera_info, at the size of the depth image: " + problem);
    }
    return out;
}

/** The frame that a message completes. */
std::optional<RecordedFrame> BagRecording::take(const rosbag::MessageInstance& message)
{
    ++numRead_;
    const bool isDepth = message.getTopic() == depth_.name;
    const std::uint32_t number = isDepth ? numDepth_++ : numColour_++;
    const auto partner = partner_.find({isDepth, number});
    if (partner == partner_.end())
    {
        return {};
    }
    try
    {
        const auto other = waiting_.find({!isDepth, partner->second});
        if (other == waiting_.end())
        {
            std::optional<Picture>& own = waiting_[{isDepth, number}];  // empty if it is bad
            own = readPicture(message);
            return {};
        }
        const std::optional<Picture> first = other->second;
        waiting_.erase(other);
        if (!first)
        {
            return {};  // that was told when it came
        }
        const Picture second = readPicture(message);
        return isDepth ? frame(*first, second) : frame(second, *first);
    }
    catch (const BadFrame& bad)
    {
        throw BadFrame(
            options_.file + ": " + message.getTopic() + ", message " + std::to_string(number) +
            ": " + bad.what());
    }
}

std::optional<RecordedFrame> BagRecording::next()
{
    try
    {
        for (; at_ != view_->end(); ++at_)
        {
            try
            {
                if (auto out = take(*at_))
                {
                    ++at_;
                    return out;
                }
            }
            catch (const BadFrame&)
            {
                ++at_;
                throw;
            }
        }
    }
    catch (const ros::Exception& e)
    {
        noteDamage(numRead_, e);
        at_ = view_->end();
    }
    return {};
}
}  // namespace

std::unique_ptr<Recording> openBag(const BagOptions& options)
{
    return std::make_unique<BagRecording>(options);
}
}  // namespace pointplane
