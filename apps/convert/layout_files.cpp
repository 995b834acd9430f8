// SPDX-License-Identifier: BSD-3-Clause
#include "layout_files.h"

#include <pointplane/core/byte_order_mark.h>
#include <pointplane/core/number_text.h>
#include <pointplane/core/read_errors.h>
#include <pointplane/mrpt_io/errors.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>

#include "image_names.h"
#include "pose_numbers.h"
#include <nlohmann/json.hpp>
#include <unistd.h>

namespace pointplane
{
namespace fs = std::filesystem;

namespace
{
/** All numbers of a text file, separated by blanks or commas. */
std::vector<double> numbersInFile(const fs::path& path)
{
    std::error_code error;
    std::ifstream file(path);
    if (!file || fs::is_directory(path, error))
    {
        throw InputError("cannot open " + path.string() + ": " + whyNoFile(path.string()));
    }
    skipByteOrderMark(file);
    std::string text = readAll(file);
    requireRead(file, path.string());
    std::replace(text.begin(), text.end(), ',', ' ');
    std::istringstream words(text);
    std::vector<double> out;
    for (std::string word; words >> word;)
    {
        const auto value = parseFinite(word);
        if (!value)
        {
            throw InputError(path.string() + ": '" + word + "' is not a number");
        }
        out.push_back(*value);
    }
    return out;
}
}  // namespace

void requireFolder(const std::string& path)
{
    std::error_code error;
    const fs::file_type type = fs::status(path, error).type();
    if (type == fs::file_type::none ||
        (type == fs::file_type::directory && ::access(path.c_str(), R_OK | X_OK) != 0))
    {
        throw InputError(
            "cannot open " + path + ": " + (error ? error.message() : std::strerror(errno)));
    }
    if (type == fs::file_type::not_found)
    {
        throw InputError(path + ": no such folder");
    }
    if (type != fs::file_type::directory)
    {
        throw InputError(path + ": is a file, not a folder; archives have to be unpacked");
    }
}

std::vector<double> numbersInLine(std::string line, const std::string& where)
{
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    std::vector<double> out;
    for (std::string word; words >> word;)
    {
        const auto value = parseNumber<double>(word);
        if (!value)
        {
            throw InputError(where + "'" + word + "' is not a number");
        }
        out.push_back(*value);
    }
    return out;
}

PinholeCamera cameraOfMatrix(const fs::path& path)
{
    const std::vector<double> m = numbersInFile(path);
    if (m.size() != 9 && m.size() != 16)
    {
        throw InputError(path.string() + ": is not a 3x3 or 4x4 matrix");
    }
    const std::size_t columns = m.size() == 9 ? 3 : 4;
    if (m[2 * columns] != 0 || m[2 * columns + 1] != 0 || m[2 * columns + 2] != 1)
    {
        throw InputError(path.string() + ": the third row of a camera's matrix is 0 0 1");
    }
    PinholeCamera out;
    out.width = out.height = 0;
    out.fx = m[0];
    out.cx = m[2];
    out.fy = m[columns + 1];
    out.cy = m[columns + 2];
    return out;
}

Eigen::Isometry3d poseOfMatrix(const fs::path& path)
{
    const auto pose = poseFromMatrix(numbersInFile(path));
    if (!pose)
    {
        throw InputError(
            path.string() +
            ": is not a 4x4 matrix of a rotation and a translation, with a last "
            "row of 0 0 0 1");
    }
    return *pose;
}

std::optional<Eigen::Isometry3d> poseIn(const fs::path& path)
{
    try
    {
        return poseFromMatrix(numbersInFile(path));
    }
    catch (const InputError&)
    {
        return {};
    }
}

std::vector<std::optional<Eigen::Isometry3d>> posesInLines(const fs::path& path)
{
    std::vector<std::optional<Eigen::Isometry3d>> out;
    std::ifstream file(path);
    skipByteOrderMark(file);
    for (std::string line; std::getline(file, line);)
    {
        std::istringstream words(line);
        std::vector<double> numbers;
        for (std::string word; words >> word;)
        {
            // What is no number makes no rotation.
            numbers.push_back(parseFinite(word).value_or(std::nan("")));
        }
        out.push_back(poseFromMatrix(numbers));
    }
    requireRead(file, path.string());
    return out;
}

std::optional<nlohmann::json> jsonIn(const fs::path& path)
{
    std::ifstream file(path);
    if (!file || !fs::is_regular_file(path))
    {
        return {};
    }
    nlohmann::json out = nlohmann::json::parse(readAll(file), nullptr, false);
    requireRead(file, path.string());
    if (out.is_discarded())
    {
        throw InputError(path.string() + ": is not JSON");
    }
    return out;
}

std::optional<nlohmann::json> jsonObjectIn(const fs::path& path)
{
    auto out = jsonIn(path);
    if (out && !out->is_object())
    {
        throw InputError(path.string() + ": is not a JSON object");
    }
    return out;
}

double numberAt(const nlohmann::json& json, const char* key, const fs::path& path)
{
    const auto found = json.find(key);
    if (found == json.end() || !found->is_number())
    {
        throw InputError(path.string() + ": has no number '" + key + "'");
    }
    return found->get<double>();
}

int pixelsIn(const nlohmann::json& json, const char* key, const fs::path& path)
{
    constexpr double kLargest = 65535;
    const double size = numberAt(json, key, path);
    if (!(size >= 1 && size <= kLargest))
    {
        throw InputError(path.string() + ": '" + key + "' is not a number of pixels");
    }
    return static_cast<int>(size);
}

std::optional<double> rateIn(const nlohmann::json& json, const fs::path& path)
{
    if (!json.contains("fps"))
    {
        return {};
    }
    const double fps = numberAt(json, "fps", path);
    if (!(fps > 0))
    {
        throw InputError(path.string() + ": 'fps' is not a positive number");
    }
    return fps;
}

PinholeCamera cameraAt(const nlohmann::json& json, const CameraKeys& keys, const fs::path& path)
{
    const auto K = json.find(keys.matrix);
    if (K == json.end() || !K->is_array() || K->size() != 9 ||
        !std::all_of(K->begin(), K->end(), [](const auto& k) { return k.is_number(); }))
    {
        throw InputError(path.string() + ": " + keys.matrix + " is not a list of 9 numbers");
    }
    const auto at = [&](std::size_t index) { return (*K)[index].get<double>(); };
    const bool isByRow = at(6) == 0 && at(7) == 0;
    PinholeCamera camera = pinholeOf(
        pixelsIn(json, keys.width, path),
        pixelsIn(json, keys.height, path),
        at(0),
        at(isByRow ? 2 : 6),
        at(isByRow ? 5 : 7));
    camera.fy = at(4);
    return camera;
}

std::optional<Calibration> open3dCamera(const nlohmann::json& json, const fs::path& path)
{
    if (!json.contains("intrinsic_matrix"))
    {
        return {};
    }
    Calibration out = colourCamera(cameraAt(json, {"intrinsic_matrix", "width", "height"}, path));
    if (json.contains("depth_scale"))  // not in the files of all recorders
    {
        out.unitsPerMetre = numberAt(json, "depth_scale", path);
        out.tellsUnits = true;
    }
    return out;
}

Calibration colourCamera(const PinholeCamera& camera)
{
    Calibration out;
    out.camera = camera;
    return out;
}

PinholeCamera pinholeOf(int width, int height, double f, double cx, double cy)
{
    PinholeCamera out;
    out.width = width;
    out.height = height;
    out.fx = out.fy = f;
    out.cx = cx;
    out.cy = cy;
    return out;
}
}  // namespace pointplane
