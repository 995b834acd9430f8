// SPDX-License-Identifier: BSD-3-Clause
#include "other_file_type.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <vector>

#include "GzInput.h"

namespace pointplane
{
namespace
{
struct KnownType
{
    std::string magic;   //!< the first bytes; empty: there are none
    std::string ending;  //!< of the name; empty: any
    OtherFileType type;
};

const std::vector<KnownType>& knownTypes()
{
    static const std::string kRos2 =
        "make a ROS 1 bag of it (rosbags-convert), then pointplane-convert bag makes a rawlog";
    static const std::string kUnpack =
        "unpack it, then pointplane-convert tum or folder makes a rawlog";
    static const OtherFileType kBag{"a ROS bag", "pointplane-convert bag makes one of it"};
    static const OtherFileType kDatabase{"a database of ROS 2", kRos2};
    static const OtherFileType kMcap{"an MCAP recording", kRos2};
    static const OtherFileType kZip{"a zip archive", kUnpack};
    static const std::vector<KnownType> kTypes{
        {"#ROSBAG", "", kBag},
        {"SQLite format 3", "", kDatabase},
        {"\x89MCAP", "", kMcap},
        {"NI10",
         "",
         {"an OpenNI recording", "pointplane-grabber --device FILE.oni makes one of it"}},
        {"\x89PNG", "", {"a picture", ""}},
        {"\xff\xd8\xff", "", {"a picture", ""}},
        {"PK\x03\x04", "", kZip},
        {"BZh", "", {"bzip2-compressed", "run bunzip2 on it"}},
        {"\xfd"
         "7zXZ",
         "",
         {"xz-compressed", "run unxz on it"}},
        {"",
         ".klg",
         {"a log of ElasticFusion by its name", "pointplane-convert klg makes one of it"}},
        {"", ".bag", kBag},
        {"", ".db3", kDatabase},
        {"", ".mcap", kMcap},
        {"", ".zip", kZip}};
    return kTypes;
}

[[nodiscard]] bool endsWith(const std::string& text, const std::string& ending)
{
    return text.size() >= ending.size() &&
           text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

/** The first bytes of a file. */
[[nodiscard]] std::string headOf(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    std::string head(256, '\0');
    file.read(head.data(), static_cast<std::streamsize>(head.size()));
    head.resize(static_cast<std::size_t>(file.gcount()));
    return head;
}

[[nodiscard]] bool isText(const std::string& head)
{
    const auto isOfText = [](unsigned char c) { return std::isprint(c) || std::isspace(c); };
    return !head.empty() && std::all_of(head.begin(), head.end(), isOfText);
}
}  // namespace

std::optional<OtherFileType> otherFileType(const std::string& path)
{
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error))
    {
        return {};  // what was read from a pipe is gone, and opening it again would wait for more
    }
    const std::string head = headOf(path);
    const auto is = [&](const KnownType& known) {
        return head.compare(0, known.magic.size(), known.magic) == 0 &&
               endsWith(path, known.ending);
    };
    const auto& types = knownTypes();
    const auto type = std::find_if(types.begin(), types.end(), is);
    if (type != types.end())
    {
        return type->type;
    }
    return isText(head) ? std::make_optional(OtherFileType{"a text file", ""}) : std::nullopt;
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
