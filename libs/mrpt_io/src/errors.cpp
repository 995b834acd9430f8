// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/mrpt_io/errors.h>

#include <opencv2/core.hpp>

#include <algorithm>
#include <filesystem>
#include <new>

namespace pointplane
{
bool isOutOfMemory(const std::exception& e)
{
    const auto* ofOpenCv = dynamic_cast<const cv::Exception*>(&e);
    return dynamic_cast<const std::bad_alloc*>(&e) != nullptr ||
           (ofOpenCv != nullptr && ofOpenCv->code == cv::Error::StsNoMem);
}

std::string whyNoFile(const std::string& path)
{
    std::error_code error;
    switch (std::filesystem::status(path, error).type())
    {
        case std::filesystem::file_type::not_found:
            return "no such file";
        case std::filesystem::file_type::none:
            return error.message();
        default:
            return "not a file";
    }
}

std::string oneLine(const std::exception& e)
{
    if (isOutOfMemory(e))
    {
        return "out of memory";
    }
    std::string text = e.what();
    bool isOfMany = dynamic_cast<const cv::Exception*>(&e) != nullptr;
    // MRPT: a title, then "Message:  <text>\nLocation: ..." once per stack frame, the innermost
    // first, or the text alone.
    for (const std::string key : {"==== MRPT exception ====", "Message:"})
    {
        if (const auto at = text.find(key); at != std::string::npos)
        {
            text = text.substr(at + key.size());
            isOfMany = true;
        }
    }
    const auto first = text.find_first_not_of(" \t\r\n");
    if (first == std::string::npos)
    {
        return "unknown error";
    }
    text = text.substr(first);
    text = text.substr(0, isOfMany ? text.find_first_of("\r\n") : std::string::npos);
    text = text.substr(0, text.find_last_not_of(" \t\r\n") + 1);
    const auto isControl = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
    std::replace_if(text.begin(), text.end(), isControl, '?');  // in the name of a file
    return text;
}
}  // namespace pointplane
