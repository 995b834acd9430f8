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
        else if (stem.find('.') != std::string::npos)
        {
            image.stamp = *first;
        }
        image.key = std::abs(*first) < 1e15 ? std::lround(*first) : 0;
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
