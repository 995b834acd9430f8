// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <rosbag/bag.h>
#include <rosbag/view.h>

namespace pointplane
{
enum class ImageKind
{
    Colour,
    Depth
};

/** A topic of images in a bag. */
struct ImageTopic
{
    std::string name, frame, encoding;
    ImageKind kind{ImageKind::Colour};

    /** Depth in the axes of the colour image, as its name tells. */
    [[nodiscard]] bool isRegistered() const;
};

[[nodiscard]] std::vector<ImageTopic> imageTopics(const rosbag::Bag& bag);

/** The one of that kind which is named `wanted`; where that is empty, the only one, or the only one
 * with a usual name. \param file for messages \throws InputError */
[[nodiscard]] ImageTopic chosenTopic(
    const std::vector<ImageTopic>& topics,
    const std::string& wanted,
    ImageKind kind,
    const std::string& file);

/** Calls f with each message of type T of a topic until f returns false. */
template <class T, class F>
void forEachMessage(const rosbag::Bag& bag, const std::string& topic, const F& f)
{
    rosbag::View view(bag, rosbag::TopicQuery(topic));
    for (const rosbag::MessageInstance& message : view)
    {
        const auto value = message.instantiate<T>();
        if (value && !f(*value))
        {
            return;
        }
    }
}
}  // namespace pointplane
