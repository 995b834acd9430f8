// SPDX-License-Identifier: BSD-3-Clause
#include "image_names.h"

#include <pointplane/core/number_text.h>
#include <pointplane/mrpt_io/errors.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <set>
#include <system_error>
#include <tuple>

namespace pointplane
{
namespace fs = std::filesystem;

namespace
{
[[nodiscard]] bool isImage(const fs::path& path)
{
    std::string extension = path.extension().string();
    std::transform(
        extension.begin(),
        extension.end(),
        extension.begin(),
        [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    constexpr std::array known{
        ".png", ".jpg", ".jpeg", ".pgm", ".ppm", ".bmp", ".tif", ".tiff", ".exr", ".pfm"};
    return std::find(known.begin(), known.end(), extension) != known.end();
}

/** What is in a folder, or nothing if there is none. \throws InputError if it cannot be read, or is
 * elsewhere than a link says: images in it would be missed */
[[nodiscard]] std::vector<fs::path> pathsIn(const fs::path& folder)
{
    std::vector<fs::path> out;
    std::error_code error, ofLink;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error))
    {
        out.push_back(entry->path());
    }
    const bool isNone =
        error == std::errc::not_a_directory ||
        (error == std::errc::no_such_file_or_directory && !fs::is_symlink(folder, ofLink));
    if (error && !isNone)
    {
        throw InputError("cannot open " + folder.string() + ": " + error.message());
    }
    return out;
}

/** Of a name that is a time since 1970: seconds with a decimal point, or so many digits that they
 * are seconds, milli-, micro- or nanoseconds of the years 2001 to 2286. */
[[nodiscard]] std::optional<double> stampOf(const std::string& name, double number)
{
    if (name.find('.') != std::string::npos)
    {
        return number;
    }
    const bool isCounter =  // 0000000017 is frame 17
        name.front() == '0' ||
        !std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isdigit(c); });
    switch (isCounter ? 0 : name.size())
    {
        case 10:
            return number;
        case 13:
            return number / 1e3;
        case 16:
            return number / 1e6;
        case 19:
            return number / 1e9;
        default:
            return {};
    }
}

/** Without its path; nothing if the name is neither number nor stamp. */
[[nodiscard]] std::optional<ImageRef> imageNamed(const std::string& stem)
{
    ImageRef image;
    const auto dash = stem.find('-', 1);
    const auto first = parseFinite(stem.substr(0, dash));
    const auto second =
        dash == std::string::npos ? std::nullopt : parseFinite(stem.substr(dash + 1));
    // Redwood has twelve digits of microseconds; 20230501-120001 is a date.
    const bool isRedwood = second && stem.size() - dash == 13;
    if (!first || (dash != std::string::npos && !isRedwood))
    {
        return {};
    }
    if (second)
    {
        image.stamp = 1e-6 * *second;
    }
    else
    {
        image.stamp = stampOf(stem, *first);
    }
    image.isNumbered = second || !image.stamp;
    if (image.isNumbered && !(std::abs(*first) < 1e15))
    {
        return {};
    }
    image.key = image.isNumbered ? std::lround(*first) : 0;
    return image;
}
}  // namespace

std::vector<std::string> imagesInFolder(const fs::path& folder)
{
    std::vector<std::string> out;
    for (const fs::path& path : pathsIn(folder))
    {
        if (isImage(path) && path.filename().string().front() != '.')
        {
            out.push_back(path.string());
        }
    }
    return out;
}

std::vector<std::string> imagesBeside(const std::vector<ImageRef>& images)
{
    std::set<fs::path> folders, taken;
    for (const ImageRef& image : images)
    {
        if (!image.path.empty())  // else it is a frame of a video
        {
            taken.insert(image.path);
            folders.insert(fs::path(image.path).parent_path());
        }
    }
    std::vector<std::string> out;
    for (const fs::path& folder : folders)
    {
        for (const std::string& image : imagesInFolder(folder))
        {
            if (taken.count(image) == 0)
            {
                out.push_back(image);
            }
        }
    }
    std::sort(out.begin(), out.end());
    return out;
}

bool isInNameOf(const fs::path& folder, const std::string& words)
{
    const fs::path whole = fs::absolute(folder).lexically_normal();
    const std::string name =
        (whole.has_filename() ? whole : whole.parent_path()).filename().string();
    const auto isInWord = [&name](std::size_t at)
    { return at < name.size() && std::isalnum(static_cast<unsigned char>(name[at])) != 0; };
    for (auto at = name.find(words); at != std::string::npos; at = name.find(words, at + 1))
    {
        if ((at == 0 || !isInWord(at - 1)) && !isInWord(at + words.size()))
        {
            return true;
        }
    }
    return false;
}

std::vector<ImageRef> imagesIn(
    const fs::path& folder, const std::string& prefix, const std::string& suffix)
{
    std::vector<ImageRef> out;
    for (const fs::path& path : pathsIn(folder))
    {
        std::string stem = path.stem().string();
        if (!isImage(path) || stem.size() < prefix.size() + suffix.size() ||
            stem.compare(0, prefix.size(), prefix) != 0 ||
            stem.compare(stem.size() - suffix.size(), suffix.size(), suffix) != 0)
        {
            continue;
        }
        stem = stem.substr(prefix.size(), stem.size() - prefix.size() - suffix.size());
        if (auto image = imageNamed(stem))
        {
            image->path = path.string();
            out.push_back(*image);
        }
    }
    std::sort(
        out.begin(),
        out.end(),
        [](const ImageRef& a, const ImageRef& b)
        {
            return std::make_tuple(a.stamp.value_or(0), a.key, a.path) <
                   std::make_tuple(b.stamp.value_or(0), b.key, b.path);
        });
    return out;
}
}  // namespace pointplane
