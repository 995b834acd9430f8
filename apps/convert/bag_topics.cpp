// SPDX-License-Identifier: BSD-3-Clause
#include "bag_topics.h"

#include <pointplane/mrpt_io/errors.h>

#include <set>

#include "ros_images.h"

namespace pointplane
{
using sensor_msgs::CompressedImage;
using sensor_msgs::Image;

namespace
{
[[nodiscard]] bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

[[nodiscard]] bool isInfrared(const ImageTopic& topic)
{
    return contains(topic.name, "nfra") || contains(topic.name, "/ir/");
}

[[nodiscard]] bool isNamedColour(const ImageTopic& topic)
{
    return contains(topic.name, "color") || contains(topic.name, "rgb");
}
}  // namespace

bool ImageTopic::isRegistered() const
{
    return contains(name, "registered") ||
           (contains(name, "aligned") && !contains(name, "aligned_depth_to_infra"));
}

std::vector<ImageTopic> imageTopics(const rosbag::Bag& bag)
{
    std::vector<ImageTopic> out;
    rosbag::View all(bag);
    std::set<std::string> seen;
    for (const rosbag::ConnectionInfo* connection : all.getConnections())
    {
        if (!seen.insert(connection->topic).second)
        {
            continue;
        }
        const auto add = [&](const auto& image, const std::string& encoding)
        {
            out.push_back(
                {connection->topic,
                 image.header.frame_id,
                 encoding,
                 isDepth(image) ? ImageKind::Depth : ImageKind::Colour});
            return false;
        };
        forEachMessage<Image>(
            bag, connection->topic, [&](const Image& image) { return add(image, image.encoding); });
        forEachMessage<CompressedImage>(
            bag,
            connection->topic,
            [&](const CompressedImage& image) { return add(image, image.format); });
    }
    return out;
}

ImageTopic chosenTopic(
    const std::vector<ImageTopic>& topics,
    const std::string& wanted,
    ImageKind kind,
    const std::string& file)
{
    const bool isDepth = kind == ImageKind::Depth;
    const std::string kindName = isDepth ? "depth" : "colour";
    std::vector<ImageTopic> candidates, preferred;
    std::string names;
    for (const ImageTopic& topic : topics)
    {
        names += (names.empty() ? "" : ", ") + topic.name;
        if (topic.name == wanted)
        {
            return topic;
        }
        if (topic.kind == kind && !isInfrared(topic))
        {
            candidates.push_back(topic);
            if (isDepth ? topic.isRegistered() : isNamedColour(topic))
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
    if (candidates.empty())
    {
        throw InputError(
            file + ": has no topic with " + kindName +
            " images, and a frame needs colour and depth (images are on: " +
            (names.empty() ? "none" : names) + "); --" + kindName +
            "-topic takes others, infrared for instance, in their place");
    }
    if (candidates.size() > 1)
    {
        throw InputError(
            file + ": has " + std::to_string(candidates.size()) + " topics with " + kindName +
            " images; choose one by --" + kindName + "-topic (images are on: " + names + ")");
    }
    return candidates.front();
}
}  // namespace pointplane
