// SPDX-License-Identifier: BSD-3-Clause
#include "folder_images.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <locale>
#include <sstream>
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
        ".png", ".jpg", ".jpeg", ".pgm", ".ppm", ".bmp", ".tif", ".tiff", ".exr"};
    return std::find(known.begin(), known.end(), extension) != known.end();
}

/** Of a name that is a time since 1970: seconds with a decimal point, or so many digits that they
 * are milli-, micro- or nanoseconds of the years 2001 to 2286. */
[[nodiscard]] std::optional<double> stampOf(const std::string& name, double number)
{
    if (name.find('.') != std::string::npos)
    {
        return number;
    }
    switch (std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isdigit(c); })
                ? name.size()
                : 0)
    {
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
}  // namespace

std::optional<double> numberOf(const std::string& text)
{
    std::istringstream in(text);
    in.imbue(std::locale::classic());
    double value = 0;
    if (in >> value && in.peek() == std::istringstream::traits_type::eof() && std::isfinite(value))
    {
        return value;
    }
    return {};
}

std::vector<ImageRef> imagesIn(
    const fs::path& folder, const std::string& prefix, const std::string& suffix)
{
    std::vector<ImageRef> out;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error))
    {
        std::string stem = entry.path().stem().string();
        if (!isImage(entry.path()) || stem.size() < prefix.size() + suffix.size() ||
            stem.compare(0, prefix.size(), prefix) != 0 ||
            stem.compare(stem.size() - suffix.size(), suffix.size(), suffix) != 0)
        {
            continue;
        }
        stem = stem.substr(prefix.size(), stem.size() - prefix.size() - suffix.size());
        ImageRef image;
        image.path = entry.path().string();
        const auto dash = stem.find('-', 1);
        const auto first = numberOf(stem.substr(0, dash));
        const auto second =
            dash == std::string::npos ? std::nullopt : numberOf(stem.substr(dash + 1));
        if (!first || (dash != std::string::npos && !second))
        {
            continue;
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
            continue;
        }
        image.key = image.isNumbered ? std::lround(*first) : 0;
        out.push_back(image);
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
