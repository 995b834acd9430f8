// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/mrpt_io/ObservationConverter.h>
#include <pointplane/mrpt_io/errors.h>

#include <opencv2/imgcodecs.hpp>

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "ConvertApp.h"
#include "TempDir.h"
#include "rawlog_samples.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pointplane::test
{
/** Runs the converter and reads what it wrote as the odometry would. */
class ConvertedRecording : public testing::Test
{
 protected:
    [[nodiscard]] int run(std::vector<std::string> args)
    {
        args.insert(args.end(), {"-o", out_, "--quiet"});
        std::ostringstream out, err;
        const int code = runConvert(args, out, err);
        text_ = out.str() + err.str();
        return code;
    }

    [[nodiscard]] std::vector<mrpt::obs::CObservation3DRangeScan::Ptr> scans() const
    {
        return scansOf(out_);
    }

    /** Frames as the odometry takes them; all must be usable. */
    [[nodiscard]] std::vector<RgbdFrame> frames() const
    {
        std::vector<RgbdFrame> out;
        for (const ConvertedFrame& converted : convertedFrames(out_))
        {
            EXPECT_EQ(converted.problem, "");
            out.push_back(converted.frame);
        }
        return out;
    }

    /** Writes a file in a folder that is made if need be. */
    void write(const std::string& name, const std::string& bytes) const
    {
        std::filesystem::create_directories(std::filesystem::path(dir_ / name).parent_path());
        writeBytes(dir_ / name, bytes);
    }

    void writeImage(const std::string& name, const cv::Mat& image) const
    {
        std::filesystem::create_directories(std::filesystem::path(dir_ / name).parent_path());
        ASSERT_TRUE(cv::imwrite(dir_ / name, image)) << name;
    }

    TempDir dir_;
    std::string in_{dir_ / "in"};
    std::string out_{dir_ / "out.rawlog"};
    std::string text_;
};

/** All pixels of one colour; its green tells the frame. */
[[nodiscard]] inline cv::Mat colourImage(int frame, int width = 64, int height = 48)
{
    return cv::Mat(height, width, CV_8UC3, cv::Scalar(200, 20 * frame + 10, 30));
}

/** All readings 1000 + frame. */
[[nodiscard]] inline cv::Mat depthImage(int frame, int width = 64, int height = 48)
{
    return cv::Mat(height, width, CV_16UC1, cv::Scalar(1000 + frame));
}

[[nodiscard]] inline std::string numbered(const char* format, int number)
{
    char out[64];
    std::snprintf(out, sizeof(out), format, number);
    return out;
}
}  // namespace pointplane::test
