// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/number_text.h>
#include <pointplane/core/trimmed.h>
#include <pointplane/mrpt_io/camera_ini.h>
#include <pointplane/mrpt_io/errors.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <sstream>

namespace pointplane
{
namespace
{
using mrpt::config::CConfigFile;

constexpr std::size_t kPlumbBob = 5;  // k1 k2 p1 p2 k3

[[noreturn]] void fail(
    const std::string& path,
    const std::string& section,
    const std::string& key,
    const std::string& problem)
{
    throw InputError(path + ": section [" + section + "]: " + key + " " + problem);
}

[[nodiscard]] std::string textOf(
    const CConfigFile& file,
    const std::string& path,
    const std::string& section,
    const std::string& key)
{
    if (!file.sectionExists(section) || !file.keyExists(section, key))
    {
        throw InputError(path + ": section [" + section + "] has no key '" + key + "'");
    }
    return trimmed(file.read_string(section, key, ""));
}

/** Between commas, if there are any, so that `0,2 -0,9` is no four numbers; else between blanks. */
[[nodiscard]] std::vector<std::string> wordsOf(const std::string& text)
{
    const bool hasBrackets = text.size() >= 2 && text.front() == '[' && text.back() == ']';
    const std::string inside = hasBrackets ? text.substr(1, text.size() - 2) : text;
    std::vector<std::string> out;
    std::istringstream in(inside);
    if (inside.find(',') == std::string::npos)
    {
        for (std::string word; in >> word;)
        {
            out.push_back(word);
        }
        return out;
    }
    for (std::string word; std::getline(in, word, ',');)
    {
        out.push_back(trimmed(word));
    }
    return out;
}

[[nodiscard]] std::vector<double> allNumbers(
    const CConfigFile& file,
    const std::string& path,
    const std::string& section,
    const std::string& key)
{
    const std::string text = textOf(file, path, section, key);
    std::vector<double> out;
    for (const std::string& word : wordsOf(text))
    {
        const auto number = parseFinite(word);
        if (!number)
        {
            fail(path, section, key, "= '" + text + "': '" + word + "' is not a number");
        }
        out.push_back(*number);
    }
    return out;
}

/** k1 k2 p1 p2 k3. */
[[nodiscard]] std::vector<double> distortionOf(
    const CConfigFile& file, const std::string& path, const std::string& section)
{
    constexpr std::size_t kWithoutK3 = 4, kRational = 8;  // k4 to k6 follow
    std::vector<double> out = allNumbers(file, path, section, "dist");
    if (out.size() != kWithoutK3 && out.size() != kPlumbBob && out.size() != kRational)
    {
        fail(path, section, "dist", "must be [k1 k2 p1 p2 k3]");
    }
    if (std::any_of(
            out.begin() + std::min(out.size(), kPlumbBob),
            out.end(),
            [](double k) { return k != 0; }))
    {
        fail(path, section, "dist", "has k4, k5 or k6, which are not supported; calibrate without");
    }
    out.resize(kPlumbBob, 0.0);
    return out;
}

[[nodiscard]] bool isPlumbBob(
    const CConfigFile& file, const std::string& path, const std::string& section)
{
    const std::string key = "distortion_model";
    const std::string model =
        file.keyExists(section, key) ? textOf(file, path, section, key) : "plumb_bob";
    if (model == "kannala_brandt")
    {
        fail(path, section, key, "= kannala_brandt: fisheye distortion is not supported");
    }
    if (model != "plumb_bob" && model != "none")
    {
        fail(path, section, key, "= '" + model + "' is neither plumb_bob nor none");
    }
    return model == "plumb_bob";
}
}  // namespace

std::vector<double> numbersInIni(
    const CConfigFile& file,
    const std::string& path,
    const std::string& section,
    const std::string& key,
    std::size_t count)
{
    std::vector<double> out = allNumbers(file, path, section, key);
    if (out.size() != count)
    {
        fail(
            path,
            section,
            key,
            "= '" + textOf(file, path, section, key) + "' is not " +
                (count == 1 ? "one number" : std::to_string(count) + " numbers"));
    }
    return out;
}

double numberInIni(
    const CConfigFile& file,
    const std::string& path,
    const std::string& section,
    const std::string& key,
    double fallback)
{
    return file.keyExists(section, key) ? numbersInIni(file, path, section, key, 1).front()
                                        : fallback;
}

mrpt::img::TCamera cameraInIni(
    const CConfigFile& file, const std::string& path, const std::string& section)
{
    constexpr double kLargest = 65535;
    const std::vector<double> size = numbersInIni(file, path, section, "resolution", 2);
    for (const double side : size)
    {
        if (!(side >= 1 && side <= kLargest) || side != std::floor(side))
        {
            fail(path, section, "resolution", "is not two whole numbers of pixels");
        }
    }
    const auto number = [&](const char* key)
    { return numbersInIni(file, path, section, key, 1).front(); };
    mrpt::img::TCamera out;
    out.ncols = static_cast<std::uint32_t>(size[0]);
    out.nrows = static_cast<std::uint32_t>(size[1]);
    const double fx = number("fx"), fy = number("fy"), cx = number("cx"), cy = number("cy");
    out.setIntrinsicParamsFromValues(fx, fy, cx, cy);
    const std::vector<double> d = distortionOf(file, path, section);
    if (isPlumbBob(file, path, section))
    {
        out.setDistortionPlumbBob(d[0], d[1], d[2], d[3], d[4]);
    }
    return out;
}
}  // namespace pointplane
