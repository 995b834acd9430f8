// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/imgcodecs.hpp>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace pointplane::fuzzing
{
/** A folder with the files of a text like this, in which a fuzzer finds names and contents to
 * change:
 *
 *     >>rgb.txt
 *     1305031102.175304 rgb/1.png
 *     >>rgb/1.png @c
 *
 * @c and the like are images, and @/ is a folder. */
class ArchiveFolder
{
 public:
    ArchiveFolder()
    {
        char pattern[] = "/dev/shm/pointplane-fuzz-XXXXXX";
        path_ = ::mkdtemp(pattern);
        const auto add = [this](char name, const char* extension, const cv::Mat& image)
        {
            std::vector<unsigned char> bytes;
            cv::imencode(extension, image, bytes);
            images_[name] = {bytes.begin(), bytes.end()};
        };
        add('c', ".png", cv::Mat(6, 8, CV_8UC3, cv::Scalar(10, 20, 30)));
        add('j', ".jpg", cv::Mat(12, 16, CV_8UC3, cv::Scalar(10, 20, 30)));
        add('g', ".pgm", cv::Mat(6, 8, CV_8UC1, cv::Scalar(10)));
        add('a', ".png", cv::Mat(6, 8, CV_16UC4, cv::Scalar(1000, 2000, 3000, 4000)));
        add('d', ".png", cv::Mat(6, 8, CV_16UC1, cv::Scalar(1000)));
        add('s', ".png", cv::Mat(3, 4, CV_16UC1, cv::Scalar(1000)));
        add('f', ".tiff", cv::Mat(6, 8, CV_32FC1, cv::Scalar(1.5)));
    }
    ~ArchiveFolder() { std::filesystem::remove_all(path_); }
    ArchiveFolder(const ArchiveFolder&) = delete;
    ArchiveFolder& operator=(const ArchiveFolder&) = delete;

    [[nodiscard]] const std::string& path() const { return path_; }

    void fill(const std::string& archive) const
    {
        std::filesystem::remove_all(path_);
        std::filesystem::create_directory(path_);
        std::istringstream lines(archive);
        std::string name, content;
        constexpr int kMostFiles = 60;
        int numFiles = 0;
        for (std::string line; std::getline(lines, line) && numFiles < kMostFiles;)
        {
            if (line.rfind(">>", 0) != 0)
            {
                content += line + "\n";
                continue;
            }
            write(name, content);
            ++numFiles;
            const std::size_t at = line.rfind(" @");
            const bool isImage = at != std::string::npos && at + 3 == line.size();
            name = line.substr(2, isImage ? at - 2 : std::string::npos);
            content.clear();
            if (isImage && line.back() == '/')
            {
                name += "/";
            }
            else if (const auto image = images_.find(line.back());
                     isImage && image != images_.end())
            {
                content = image->second;
            }
        }
        write(name, content);
    }

 private:
    /** Nothing where the name leads out of the folder, and no video: FFmpeg has its own fuzzers. */
    void write(const std::string& name, const std::string& content) const
    {
        namespace fs = std::filesystem;
        const fs::path inside = fs::path(name).lexically_normal();
        const std::string text = inside.string();
        if (text.empty() || inside.is_absolute() || *inside.begin() == ".." ||
            inside.extension() == ".mp4" || text.find('\0') != std::string::npos)
        {
            return;
        }
        const fs::path path = fs::path(path_) / inside;
        std::error_code error;  // of names that are too long, or are a file before
        fs::create_directories(path.parent_path(), error);
        std::ofstream(path, std::ios::binary) << content;
    }

    std::string path_;
    std::map<char, std::string> images_;
};
}  // namespace pointplane::fuzzing
