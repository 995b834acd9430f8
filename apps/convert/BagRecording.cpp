// SPDX-License-Identifier: BSD-3-Clause
#include "BagRecording.h"

#include <pointplane/evaluation/association.h>
#include <pointplane/mrpt_io/mrpt_poses.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>

#include "StaticTransforms.h"
#include "ros_images.h"
#include "tum_camera.h"
#include <geometry_msgs/Transform.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <std_msgs/Float32.h>
#include <tf2_msgs/TFMessage.h>

namespace pointplane
{
namespace
{
using sensor_msgs::CameraInfo;
using sensor_msgs::CompressedImage;
using sensor_msgs::Image;

/** Of depth in floating point metres: a quarter of a millimetre, up to 16 m. */
constexpr double kUnitsOfFloat = 4000;

[[nodiscard]] bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

/** A topic of images. */
struct ImageTopic
{
    std::string name, frame, encoding;
    bool isDepth{false};
};

[[nodiscard]] Eigen::Isometry3d fromRos(const geometry_msgs::Transform& t)
{
    Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
    out.linear() = Eigen::Quaterniond(t.rotation.w, t.rotation.x, t.rotation.y, t.rotation.z)
                       .normalized()
                       .toRotationMatrix();
    out.translation() << t.translation.x, t.translation.y, t.translation.z;
    return out;
}

/** Stamp of a message's header, and its picture. */
struct Picture
{
    double stamp{0};
    cv::Mat image;
};

[[nodiscard]] Picture readPicture(const rosbag::MessageInstance& message, bool onlyStamp)
{
    const auto read = [&](const auto& m) {
        return Picture{m->header.stamp.toSec(), onlyStamp ? cv::Mat() : toMat(*m)};
    };
    if (const auto image = message.instantiate<Image>())
    {
        return read(image);
    }
    if (const auto image = message.instantiate<CompressedImage>())
    {
        return read(image);
    }
    throw BadFrame("is not an image");
}

class BagRecording : public Recording
{
 public:
    explicit BagRecording(const BagOptions& options) : options_(options)
    {
        if (!std::filesystem::is_regular_file(options.file))
        {
            throw InputError("cannot open " + options.file + ": no such file");
        }
        try
        {
            bag_.open(options.file, rosbag::bagmode::Read);
            chooseTopics();
            readCameras();
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
            throw InputError(options.file + ": " + e.what());
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
    [[nodiscard]] std::vector<ImageTopic> imageTopics();
    [[nodiscard]] static ImageTopic chosen(
        const std::vector<ImageTopic>& topics,
        const std::string& wanted,
        bool isDepth,
        const std::string& file);
    void chooseTopics();
    void readCameras();
    [[nodiscard]] PinholeCamera cameraOf(const ImageTopic& topic);
    [[nodiscard]] std::optional<Eigen::Isometry3d> extrinsicsOf(const ImageTopic& topic);
    void pair();
    [[nodiscard]] RecordedFrame frame(const Picture& colour, const Picture& depth) const;
    template <class T, class F>
    void forEach(const std::string& topic, const F& f);

    BagOptions options_;
    rosbag::Bag bag_;
    ImageTopic colour_, depth_;
    PinholeCamera camera_;
    std::optional<DepthCamera> depthCamera_;
    double unitsPerMetre_{1000};
    std::map<std::pair<bool, std::uint32_t>, std::uint32_t> partner_;  //!< by (isDepth, number)
    std::map<std::pair<bool, std::uint32_t>, std::optional<Picture>> waiting_;
    std::unique_ptr<rosbag::View> view_;
    rosbag::View::iterator at_;
    std::uint32_t numRead_{0}, numColour_{0}, numDepth_{0};
    std::string damage_;
    std::vector<std::string> notes_;
};

template <class T, class F>
void BagRecording::forEach(const std::string& topic, const F& f)
{
    rosbag::View view(bag_, rosbag::TopicQuery(topic));
    for (const rosbag::MessageInstance& message : view)
    {
        const auto value = message.instantiate<T>();
        if (value && !f(*value))
        {
            return;
        }
    }
}

std::vector<ImageTopic> BagRecording::imageTopics()
{
    std::vector<ImageTopic> out;
    rosbag::View all(bag_);
    std::set<std::string> seen;
    for (const rosbag::ConnectionInfo* connection : all.getConnections())
    {
        if (!seen.insert(connection->topic).second)
        {
            continue;
        }
        const auto add = [&](const auto& image, const std::string& encoding)
        {
            out.push_back({connection->topic, image.header.frame_id, encoding, isDepth(image)});
            return false;
        };
        forEach<Image>(
            connection->topic, [&](const Image& image) { return add(image, image.encoding); });
        forEach<CompressedImage>(
            connection->topic,
            [&](const CompressedImage& image) { return add(image, image.format); });
    }
    return out;
}

ImageTopic BagRecording::chosen(
    const std::vector<ImageTopic>& topics,
    const std::string& wanted,
    bool isDepth,
    const std::string& file)
{
    const std::string kind = isDepth ? "depth" : "colour";
    std::vector<ImageTopic> candidates, preferred;
    std::string names;
    for (const ImageTopic& topic : topics)
    {
        names += (names.empty() ? "" : ", ") + topic.name;
        if (topic.name == wanted)
        {
            return topic;
        }
        const bool isInfrared = contains(topic.name, "nfra") || contains(topic.name, "/ir/");
        if (topic.isDepth == isDepth && !isInfrared)
        {
            candidates.push_back(topic);
            if (isDepth ? contains(topic.name, "registered") || contains(topic.name, "aligned")
                        : contains(topic.name, "color") || contains(topic.name, "rgb"))
            {
                preferred.push_back(topic);
            }
        }
    }
    if (!wanted.empty())
    {
        throw InputError(file + ": has no images on " + wanted + " (those with: " + names + ")");
    }
    if (candidates.size() > 1 && preferred.size() == 1)
    {
        return preferred.front();
    }
    if (candidates.size() != 1)
    {
        throw InputError(
            file + ": has " + std::to_string(candidates.size()) + " topics with " + kind +
            " images; choose one by --" + kind +
            "-topic (images are on: " + (names.empty() ? "none" : names) + ")");
    }
    return candidates.front();
}

void BagRecording::chooseTopics()
{
    const std::vector<ImageTopic> topics = imageTopics();
    colour_ = chosen(topics, options_.colourTopic, false, options_.file);
    depth_ = chosen(topics, options_.depthTopic, true, options_.file);
    notes_.push_back(
        "colour: " + colour_.name + " (" + colour_.encoding + "), depth: " + depth_.name + " (" +
        depth_.encoding + ")");
}

PinholeCamera BagRecording::cameraOf(const ImageTopic& topic)
{
    // .../camera_info beside the images; RealSense's recorder: .../Depth_0/info/camera_info.
    std::string base = topic.name;
    std::vector<std::string> names;
    for (int up = 0; up < 2; ++up)
    {
        const auto slash = base.rfind('/');
        base = slash == std::string::npos ? "" : base.substr(0, slash);
        names.push_back(base + "/camera_info");
        names.push_back(base + "/info/camera_info");
    }
    for (const std::string& name : names)
    {
        std::optional<PinholeCamera> out;
        forEach<CameraInfo>(
            name,
            [&](const CameraInfo& info)
            {
                out = toCamera(info, contains(topic.name, "rect"));
                return false;
            });
        if (out)
        {
            const std::string problem = out->problem();
            if (!problem.empty())
            {
                throw InputError(options_.file + ": " + name + ": " + problem);
            }
            return *out;
        }
    }
    throw InputError(
        options_.file + ": has no camera_info beside " + topic.name +
        "; give a calibration by --camera");
}

/** RealSense's recorder: points of the reference stream in this one's axes. */
std::optional<Eigen::Isometry3d> BagRecording::extrinsicsOf(const ImageTopic& topic)
{
    const auto image = topic.name.rfind("/image/data");
    std::optional<Eigen::Isometry3d> out;
    if (image != std::string::npos)
    {
        forEach<geometry_msgs::Transform>(
            topic.name.substr(0, image) + "/tf/0",
            [&](const geometry_msgs::Transform& t)
            {
                out = fromRos(t);
                return false;
            });
    }
    return out;
}

void BagRecording::readCameras()
{
    const auto sensor = depth_.name.find("/Depth_0/");
    if (sensor != std::string::npos)
    {
        forEach<std_msgs::Float32>(
            depth_.name.substr(0, sensor) + "/option/Depth_Units/value",
            [&](const std_msgs::Float32& unit)
            {
                unitsPerMetre_ =
                    unit.data > 0 ? std::round(1e6 / static_cast<double>(unit.data)) * 1e-6 : 1000;
                return false;
            });
    }
    if (options_.depthScale > 0)
    {
        unitsPerMetre_ = options_.depthScale;
    }
    camera_ =
        options_.camera.empty() ? cameraOf(colour_) : loadTumCamera(options_.camera, "").camera;
    if (colour_.frame == depth_.frame && !colour_.frame.empty())
    {
        if (!extrinsicsOf(depth_))
        {
            return;  // registered; the depth image may yet have another size
        }
    }
    else if (contains(depth_.name, "registered") || contains(depth_.name, "aligned"))
    {
        return;
    }
    depthCamera_ = DepthCamera{cameraOf(depth_), Eigen::Isometry3d::Identity()};
    const auto ofDepth = extrinsicsOf(depth_), ofColour = extrinsicsOf(colour_);
    if (ofDepth && ofColour)
    {
        depthCamera_->T_depth_colour = *ofDepth * ofColour->inverse();
        return;
    }
    StaticTransforms transforms;
    for (const char* topic : {"/tf_static", "tf_static", "/tf", "tf"})
    {
        forEach<tf2_msgs::TFMessage>(
            topic,
            [&](const tf2_msgs::TFMessage& message)
            {
                for (const auto& t : message.transforms)
                {
                    transforms.add(t.header.frame_id, t.child_frame_id, fromRos(t.transform));
                }
                return true;
            });
    }
    if (const auto T = transforms.between(depth_.frame, colour_.frame))
    {
        depthCamera_->T_depth_colour = *T;
    }
    else
    {
        notes_.push_back(
            "no transform between " + depth_.frame + " and " + colour_.frame +
            ": the two cameras are taken to be in one place");
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
            const double stamp = readPicture(message, true).stamp;
            (message.getTopic() == depth_.name ? depth : colour).push_back(stamp);
        }
    }
    catch (const ros::Exception& e)
    {
        // Read again, the library may go on as if nothing were wrong.
        damage_ = options_.file + ": damaged after message " +
                  std::to_string(colour.size() + depth.size()) + " of its images: " + e.what();
    }
    for (const auto& [c, d] : associate(colour, depth, 0.0, options_.maxDifference))
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
        notes_.push_back(std::to_string(alone) + " images without a partner were left out");
    }
}

RecordedFrame BagRecording::frame(const Picture& colour, const Picture& depth) const
{
    RecordedFrame out;
    out.depthDelay = depth.stamp - colour.stamp;
    RegisteredScan& scan = out.scan;
    scan.stamp = fromSeconds(colour.stamp);
    scan.camera = camera_;
    scan.depthCamera = depthCamera_;
    scan.colour = colour.image;
    scan.depth = depth.image;
    scan.unitsPerMetre = unitsPerMetre_;
    if (scan.depth.type() == CV_32FC1)
    {
        scan.depth = depthInUnits(scan.depth, kUnitsOfFloat);
        scan.unitsPerMetre = kUnitsOfFloat;
    }
    if (!scan.depthCamera && scan.depth.size() != scan.colour.size())
    {
        scan.depthCamera = DepthCamera{
            camera_.scaled(static_cast<double>(scan.depth.cols) / camera_.width),
            Eigen::Isometry3d::Identity()};
        scan.depthCamera->camera.distortion = {};
    }
    const PinholeCamera& ofDepth = scan.depthCamera ? scan.depthCamera->camera : camera_;
    if (scan.colour.size() != cv::Size(camera_.width, camera_.height) ||
        scan.depth.size() != cv::Size(ofDepth.width, ofDepth.height) ||
        scan.depth.type() != CV_16UC1 || scan.colour.depth() != CV_8U)
    {
        throw BadFrame("images are not of the size or kind that camera_info says");
    }
    return out;
}

std::optional<RecordedFrame> BagRecording::next()
{
    try
    {
        for (; at_ != view_->end(); ++at_)
        {
            ++numRead_;
            const bool isDepth = at_->getTopic() == depth_.name;
            const std::uint32_t number = isDepth ? numDepth_++ : numColour_++;
            const auto partner = partner_.find({isDepth, number});
            if (partner == partner_.end())
            {
                continue;
            }
            std::optional<Picture> own;
            std::string problem;
            try
            {
                own = readPicture(*at_, false);
            }
            catch (const BadFrame& bad)
            {
                problem = bad.what();
            }
            const auto other = waiting_.find({!isDepth, partner->second});
            const bool isComplete = other != waiting_.end();
            const std::optional<Picture> first = isComplete ? other->second : std::nullopt;
            const bool isFirstBad = isComplete && !first;
            if (isComplete)
            {
                waiting_.erase(other);
            }
            else
            {
                waiting_[{isDepth, number}] = own;
            }
            if (!problem.empty() && !isFirstBad)
            {
                ++at_;
                throw BadFrame(
                    options_.file + ": " + (isDepth ? depth_ : colour_).name + ", message " +
                    std::to_string(number) + ": " + problem);
            }
            if (isComplete && first && own)
            {
                ++at_;
                try
                {
                    return isDepth ? frame(*first, *own) : frame(*own, *first);
                }
                catch (const BadFrame& bad)
                {
                    throw BadFrame(
                        options_.file + ": " + (isDepth ? depth_ : colour_).name + ", message " +
                        std::to_string(number) + ": " + bad.what());
                }
            }
        }
    }
    catch (const ros::Exception& e)
    {
        if (damage_.empty())
        {
            damage_ = options_.file + ": damaged after message " + std::to_string(numRead_) +
                      " of its images: " + e.what();
        }
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
