// SPDX-License-Identifier: BSD-3-Clause
#include "cameraText.h"

#include <pointplane/core/number_text.h>
#include <pointplane/mrpt_io/ObservationConverter.h>
#include <pointplane/mrpt_io/errors.h>

#include <cmath>
#include <sstream>

namespace pointplane
{
namespace
{
constexpr const char* kMark = "pointplane-camera";

[[nodiscard]] InputError problem(const std::string& what)
{
    return InputError("comment '" + std::string(kMark) + "': " + what);
}

/** Words end at blanks: these are written as %20, like those of addresses. */
[[nodiscard]] std::string escaped(const std::string& label)
{
    std::ostringstream out;
    out << std::hex << std::uppercase;
    for (const char c : label)
    {
        const auto byte = static_cast<unsigned char>(c);
        if (byte <= ' ' || byte == 0x7f || c == '%')
        {
            out << '%' << (byte < 0x10 ? "0" : "") << static_cast<unsigned>(byte);
        }
        else
        {
            out << c;
        }
    }
    return out.str();
}

[[nodiscard]] std::string unescaped(const std::string& word)
{
    std::string out;
    for (std::size_t i = 0; i < word.size(); ++i)
    {
        const std::string digits = word.substr(i + 1, 2);
        const bool isCode = word[i] == '%' && digits.size() == 2 &&
                            digits.find_first_not_of("0123456789ABCDEFabcdef") == std::string::npos;
        out += isCode ? static_cast<char>(std::stoi(digits, nullptr, 16)) : word[i];
        i += isCode ? digits.size() : 0;
    }
    return out;
}

/** Sets what a key of the comment tells. */
void set(CameraComment& comment, const std::string& key, const std::string& value)
{
    if (key == "label")
    {
        comment.label = unescaped(value);
        return;
    }
    if (key == "intrinsics")
    {
        if (value != "nominal" && value != "calibrated")
        {
            throw problem("intrinsics is '" + value + "', not nominal or calibrated");
        }
        comment.isNominal = value == "nominal";
        return;
    }
    double* target = key == "readoutColour"  ? &comment.shutter.readoutColour
                     : key == "readoutDepth" ? &comment.shutter.readoutDepth
                     : key == "depthDelay"   ? &comment.shutter.depthDelay
                                             : nullptr;
    if (target == nullptr)
    {
        comment.unknownKeys.push_back(key);
        return;
    }
    const auto number = parseFinite(value);
    if (!number)
    {
        throw problem("'" + value + "' is not a number of seconds (key " + key + ")");
    }
    *target = *number;
}
}  // namespace

std::optional<CameraComment> parseCameraComment(const std::string& text)
{
    std::istringstream words(text);
    std::string word;
    if (!(words >> word) || word != kMark)
    {
        return {};
    }
    CameraComment out;
    while (words >> word)
    {
        const std::size_t equals = word.find('=');
        const std::string value = equals == std::string::npos ? "" : word.substr(equals + 1);
        set(out, word.substr(0, equals), value);
    }
    if (out.label.empty())
    {
        throw problem("key label is missing");
    }
    return out;
}

std::string cameraComment(const std::string& label, const ShutterModel& shutter, bool isNominal)
{
    std::string out = std::string(kMark) + " label=" + escaped(label);
    out += isNominal ? " intrinsics=nominal" : "";
    const auto append = [&out](const char* key, double value)
    {
        if (std::isfinite(value))
        {
            out += std::string(" ") + key + "=" + numberText(value);
        }
    };
    append("readoutColour", shutter.readoutColour);
    append("readoutDepth", shutter.readoutDepth);
    append("depthDelay", shutter.depthDelay);
    return out;
}
}  // namespace pointplane
