// SPDX-License-Identifier: BSD-3-Clause
#include "TumFolder.h"

#include <pointplane/core/byte_order_mark.h>
#include <pointplane/core/read_errors.h>
#include <pointplane/core/trimmed.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/mrpt_poses.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <system_error>

namespace pointplane
{
namespace
{
namespace fs = std::filesystem;

/** The rest of the line, in which names may have blanks. */
[[nodiscard]] std::string nameAfter(const std::string& stamp, const std::string& line)
{
    return trimmed(line.substr(line.find(stamp) + stamp.size()));
}

[[nodiscard]] bool hasBlank(const std::string& name)
{
    return name.find_first_of(" \t") != std::string::npos;
}

[[nodiscard]] bool isThere(const fs::path& path)
{
    std::error_code error;
    return fs::exists(path, error);
}

/** \param where for messages \return nothing for a comment or an empty line */
[[nodiscard]] std::optional<TumImage> imageOf(
    const std::string& line, const fs::path& folder, const std::string& where)
{
    std::istringstream words(line);
    std::string stamp;
    if (!(words >> stamp) || stamp[0] == '#')
    {
        return {};
    }
    const std::string name = nameAfter(stamp, line);
    if (name.empty() || (hasBlank(name) && !isThere(folder / name)))
    {
        throw InputError(
            where + "expected 'stamp file', found '" + line + "'" +
            (hasBlank(name) ? "; no file is named '" + name + "'" : ""));
    }
    try
    {
        const auto time = stampFromText(stamp);
        return TumImage{time, toSeconds(time), (folder / name).string()};
    }
    catch (const InputError& e)
    {
        throw InputError(where + e.what());
    }
}
}  // namespace

std::vector<TumImage> readTumListing(const std::string& folder, const std::string& listing)
{
    const std::string path = folder + "/" + listing;
    std::ifstream file(path);
    if (!file)
    {
        throw InputError(
            "cannot open " + path + ": " + std::strerror(errno) +
            "; without lists, pointplane-convert folder takes folders of colour and depth images");
    }
    skipByteOrderMark(file);
    std::vector<TumImage> images;
    std::string line;
    for (int number = 1; std::getline(file, line); ++number)
    {
        if (const auto image = imageOf(line, folder, path + ":" + std::to_string(number) + ": "))
        {
            images.push_back(*image);
        }
    }
    requireRead(file, path);
    if (images.empty())
    {
        throw InputError(path + ": lists no images");
    }
    std::stable_sort(
        images.begin(),
        images.end(),
        [](const TumImage& a, const TumImage& b) { return a.stamp < b.stamp; });
    const auto isSame = [](const TumImage& a, const TumImage& b)
    { return a.stamp == b.stamp && a.path == b.path; };
    images.erase(std::unique(images.begin(), images.end(), isSame), images.end());
    return images;
}
}  // namespace pointplane
