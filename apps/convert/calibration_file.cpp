// SPDX-License-Identifier: BSD-3-Clause
#include "calibration_file.h"

#include <pointplane/core/byte_order_mark.h>
#include <pointplane/core/number_text.h>
#include <pointplane/core/read_errors.h>
#include <pointplane/mrpt_io/ScanWriter.h>
#include <pointplane/mrpt_io/camera_ini.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/ini_file.h>
#include <pointplane/mrpt_io/mrpt_camera.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <system_error>
#include <vector>

#include "image_names.h"
#include "layout_files.h"
#include <nlohmann/json.hpp>

namespace pointplane
{
namespace
{
struct Preset
{
    const char* name;
    const char* longName;
    std::array<double, 4> intrinsics;  //!< fx fy cx cy [px]
    std::array<double, 5> distortion;  //!< k1 k2 p1 p2 k3
};

/** The colour cameras of the TUM RGB-D benchmark, as published with it. */
const std::array<Preset, 3> kPresets{{
    {"fr1",
     "freiburg1",
     {{517.306408, 516.469215, 318.643040, 255.313989}},
     {{0.262383, -0.953104, -0.005358, 0.002628, 1.163314}}},
    {"fr2",
     "freiburg2",
     {{520.908620, 521.007327, 325.141442, 249.701764}},
     {{0.231222, -0.784899, -0.003257, -0.000105, 0.917205}}},
    {"fr3", "freiburg3", {{535.4, 539.2, 320.1, 247.6}}, {{0, 0, 0, 0, 0}}},
}};

/** Ending of MRPT's section of the colour camera. */
const std::string kRight = "_RIGHT";

[[nodiscard]] Calibration fromPreset(const Preset& preset)
{
    Calibration out;
    out.camera.fx = preset.intrinsics[0];
    out.camera.fy = preset.intrinsics[1];
    out.camera.cx = preset.intrinsics[2];
    out.camera.cy = preset.intrinsics[3];
    out.camera.distortion = preset.distortion;
    return out;
}

/** All numbers of a text, in which # begins a comment. Nothing if another word is in it. */
[[nodiscard]] std::optional<std::vector<double>> numbersIn(const std::string& path)
{
    std::ifstream file(path);
    skipByteOrderMark(file);
    std::vector<double> numbers;
    std::string line;
    while (std::getline(file, line))
    {
        std::istringstream words(line);
        std::string word;
        while (words >> word && word[0] != '#')
        {
            const auto number = parseFinite(word);
            if (!number)
            {
                return {};
            }
            numbers.push_back(*number);
        }
    }
    requireRead(file, path);
    return numbers;
}

/** One line: fx fy cx cy k1 k2 p1 p2 k3 width height unitsPerMetre. Nothing if it is not that. */
[[nodiscard]] std::optional<Calibration> fromLine(const std::string& path)
{
    const auto read = numbersIn(path);
    if (!read || read->size() != 12)
    {
        return {};
    }
    const std::vector<double>& numbers = *read;
    constexpr double kLargest = 65535;
    for (const double side : {numbers[9], numbers[10]})
    {
        if (!(side >= 1 && side <= kLargest) || side != std::floor(side))
        {
            throw InputError(path + ": width and height are not whole numbers of pixels");
        }
    }
    Calibration out;
    out.camera.fx = numbers[0];
    out.camera.fy = numbers[1];
    out.camera.cx = numbers[2];
    out.camera.cy = numbers[3];
    std::copy_n(numbers.begin() + 4, 5, out.camera.distortion.begin());
    out.camera.width = static_cast<int>(numbers[9]);
    out.camera.height = static_cast<int>(numbers[10]);
    out.unitsPerMetre = numbers[11];
    out.tellsUnits = true;
    return out;
}

/** The section of an MRPT ini that describes the colour camera: the only camera, or the right one
 * of a pair (MRPT's RGB-D sensors call depth left and colour right). */
[[nodiscard]] std::string cameraSection(
    const mrpt::config::CConfigFile& ini, const std::string& path)
{
    std::vector<std::string> sections, cameras, right;
    ini.getAllSections(sections);
    for (const std::string& section : sections)
    {
        if (ini.keyExists(section, "fx"))
        {
            cameras.push_back(section);
            if (section.size() >= kRight.size() &&
                section.compare(section.size() - kRight.size(), kRight.size(), kRight) == 0)
            {
                right.push_back(section);
            }
        }
    }
    if (cameras.size() == 1)
    {
        return cameras.front();
    }
    if (right.size() == 1)
    {
        return right.front();
    }
    throw InputError(
        path +
        ": is neither one line of 12 numbers, fx fy cx cy k1 k2 p1 p2 k3 width height "
        "unitsPerMetre, nor an MRPT camera ini (" +
        std::to_string(cameras.size()) + " sections with fx)");
}

[[nodiscard]] Calibration fromIni(const std::string& path)
{
    const auto file = openIniFile(path);
    const mrpt::config::CConfigFile& ini = *file;
    const std::string section = cameraSection(ini, path);
    Calibration out;
    out.camera = fromMrpt(cameraInIni(ini, path, section));
    const std::string left = section.substr(0, section.rfind(kRight)) + "_LEFT";
    if (ini.keyExists(left, "fx"))
    {
        out.unused = path + ": [" + left +
                     "], the depth camera, was not used: depth is taken for registered to colour";
    }
    return out;
}

[[nodiscard]] Calibration fromJson(const std::string& path)
{
    const auto json = jsonObjectIn(path);
    const auto camera = json ? open3dCamera(*json, path) : std::nullopt;
    if (!camera)
    {
        throw InputError(path + ": has no intrinsic_matrix, as Open3D's calibrations have");
    }
    return *camera;
}

[[nodiscard]] bool isFile(const std::string& path)
{
    std::error_code error;
    return std::filesystem::is_regular_file(path, error);
}

[[nodiscard]] Calibration fromFile(const std::string& path)
{
    const bool isJson = std::filesystem::path(path).extension() == ".json";
    const auto line = isJson ? std::nullopt : fromLine(path);
    Calibration camera = line ? *line : isJson ? fromJson(path) : fromIni(path);
    if (const std::string problem = camera.camera.problem(); !problem.empty())
    {
        throw InputError(path + ": " + problem);
    }
    if (const std::string problem = problemOfDepthUnits(camera.unitsPerMetre); !problem.empty())
    {
        throw InputError(path + ": depth units per metre: " + problem);
    }
    return camera;
}
}  // namespace

Calibration loadCalibration(const std::string& camera, const std::string& folder)
{
    const std::string local = folder + "/camera.txt";
    if (camera.empty() && std::filesystem::exists(local))
    {
        return loadCalibrationFile(local);
    }
    for (const Preset& preset : kPresets)
    {
        const bool guessed = camera.empty() && (isInNameOf(folder, preset.longName) ||
                                                isInNameOf(folder, preset.name));
        if (guessed || camera == preset.name)
        {
            Calibration out = fromPreset(preset);
            out.guessed = guessed ? preset.name : "";
            return out;
        }
    }
    if (camera.empty())
    {
        throw InputError(
            folder + ": no camera.txt in it; say --camera fr1, fr2, fr3 or a calibration file");
    }
    if (!isFile(camera))
    {
        throw InputError("--camera " + camera + ": neither fr1, fr2, fr3 nor a file");
    }
    return fromFile(camera);
}

Calibration loadCalibrationFile(const std::string& path)
{
    if (!isFile(path))
    {
        const bool isPreset = std::any_of(
            kPresets.begin(), kPresets.end(), [&](const Preset& p) { return path == p.name; });
        throw InputError(
            "--camera " + path + ": is not a file" +
            (isPreset ? "; only tum and bag know the cameras fr1, fr2, fr3" : ""));
    }
    return fromFile(path);
}
}  // namespace pointplane
