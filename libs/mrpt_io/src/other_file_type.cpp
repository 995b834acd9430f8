// SPDX-License-Identifier: BSD-3-Clause
#include "other_file_type.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <utility>
#include <vector>

#include "GzInput.h"

namespace pointplane
{
std::string otherFileType(const std::string& path)
{
    static const std::vector<std::pair<std::string, const char*>> kTypes{
        {"#ROSBAG", "a ROS bag"},
        {"SQLite format 3", "a database (of ROS 2, perhaps)"},
        {"\x89MCAP", "an MCAP recording"},
        {"NI10", "an OpenNI recording (pointplane-grabber --device FILE.oni converts it)"},
        {"\x89PNG", "a picture"},
        {"\xff\xd8\xff", "a picture"},
        {"PK\x03\x04", "a zip archive"},
        {"BZh", "bzip2-compressed"},
        {"\xfd"
         "7zXZ",
         "xz-compressed"}};
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error))
    {
        return "";  // what was read from a pipe is gone, and opening it again would wait for more
    }
    std::ifstream file(path, std::ios::binary);
    std::string head(256, '\0');
    file.read(head.data(), static_cast<std::streamsize>(head.size()));
    head.resize(static_cast<std::size_t>(file.gcount()));
    for (const auto& [magic, name] : kTypes)
    {
        if (head.compare(0, magic.size(), magic) == 0)
        {
            return name;
        }
    }
    const bool isText =
        !head.empty() && std::all_of(
                             head.begin(),
                             head.end(),
                             [](unsigned char c) { return std::isprint(c) || std::isspace(c); });
    return isText ? "a text file" : "";
}

bool isCompressedTwice(const std::string& path)
{
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error))
    {
        return false;  // what was read from a pipe is gone
    }
    GzInput in(path);
    std::uint8_t head[2] = {0, 0};
    return in.isCompressed() && in.read(head, sizeof(head)) == sizeof(head) && head[0] == 0x1f &&
           head[1] == 0x8b;
}
}  // namespace pointplane
