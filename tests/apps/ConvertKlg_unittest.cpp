// SPDX-License-Identifier: BSD-3-Clause
#include <opencv2/imgproc.hpp>

#include <cstdint>
#include <cstring>
#include <limits>

#include "converted_recordings.h"
#include <zlib.h>

namespace pointplane
{
namespace
{
using testing::HasSubstr;

template <class T>
void append(std::string& out, const T& value)
{
    out.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

[[nodiscard]] std::string bytesOf(const cv::Mat& image)
{
    return {reinterpret_cast<const char*>(image.data), image.total() * image.elemSize()};
}

[[nodiscard]] std::string compressed(const std::string& bytes)
{
    uLongf size = compressBound(bytes.size());
    std::string out(size, 0);
    EXPECT_EQ(
        compress(
            reinterpret_cast<Bytef*>(out.data()),
            &size,
            reinterpret_cast<const Bytef*>(bytes.data()),
            bytes.size()),
        Z_OK);
    out.resize(size);
    return out;
}

/** As ElasticFusion's Logger2 writes it: RGB, which OpenCV's encoder takes for BGR. */
[[nodiscard]] std::string log(
    int numFrames, bool isCompressed, std::int64_t start = 5000000, std::int64_t step = 33333)
{
    std::string out;
    append(out, static_cast<std::int32_t>(numFrames));
    for (int i = 0; i < numFrames; ++i)
    {
        cv::Mat rgb;
        cv::cvtColor(test::colourImage(i), rgb, cv::COLOR_BGR2RGB);
        std::string depth = bytesOf(test::depthImage(i)), colour = bytesOf(rgb);
        if (isCompressed)
        {
            depth = compressed(depth);
            std::vector<uchar> jpeg;
            cv::imencode(".jpg", rgb, jpeg);
            colour.assign(jpeg.begin(), jpeg.end());
        }
        append(out, start + step * i);
        append(out, static_cast<std::int32_t>(depth.size()));
        append(out, static_cast<std::int32_t>(colour.size()));
        out += depth + colour;
    }
    return out;
}

class ConvertKlg : public test::ConvertedRecording
{
 protected:
    void SetUp() override { write("camera.txt", "60 60 31.5 23.5 0 0 0 0 0 64 48 1000\n"); }
    [[nodiscard]] int convert(const std::string& bytes, std::vector<std::string> more = {})
    {
        write("in.klg", bytes);
        more.insert(more.begin(), {"klg", dir_ / "in.klg", "--camera", dir_ / "camera.txt"});
        return run(more);
    }
};
}  // namespace

TEST_F(ConvertKlg, plainAndCompressed)
{
    for (const bool isCompressed : {false, true})
    {
        ASSERT_EQ(convert(log(3, isCompressed)), kExitOk) << text_;
        const auto found = frames();
        ASSERT_EQ(found.size(), 3U);
        for (int i = 0; i < 3; ++i)
        {
            const RgbdFrame& frame = found[static_cast<std::size_t>(i)];
            EXPECT_NEAR(frame.stamp, 5 + 0.033333 * i, 1e-6);
            EXPECT_NEAR(frame.depth.at<float>(20, 30), 1 + 1e-3 * i, 1e-6);
            EXPECT_NEAR(
                frame.gray.at<uchar>(20, 30), 0.114 * 200 + 0.587 * (20 * i + 10) + 0.299 * 30, 3);
        }
    }
}

TEST_F(ConvertKlg, aCameraOfTheTumBenchmarkIsNone)
{
    write("in.klg", log(3, true));
    EXPECT_EQ(run({"klg", dir_ / "in.klg", "--camera", "fr1"}), kExitBadInput);
    EXPECT_THAT(text_, HasSubstr("--camera fr1: is not a file; only tum and bag know"));
}

TEST_F(ConvertKlg, truncatedAnywhereKeepsWhatIsBefore)
{
    const std::string whole = log(3, true);
    const std::string two = log(2, true);
    for (const std::size_t size : {two.size() + 3, two.size() + 14, whole.size() - 1})
    {
        ASSERT_EQ(convert(whole.substr(0, size)), kExitIncomplete) << size;
        EXPECT_THAT(text_, HasSubstr("frame 2 of 3"));
        EXPECT_EQ(frames().size(), 2U);
    }
    std::filesystem::remove(out_);
    EXPECT_EQ(convert(whole.substr(0, whole.size() - 1), {"--strict"}), kExitBadInput);
    EXPECT_FALSE(std::filesystem::exists(out_));
    EXPECT_EQ(convert(""), kExitBadInput);
    EXPECT_EQ(convert("abc"), kExitBadInput);
    EXPECT_EQ(run({"klg", dir_ / "none.klg"}), kExitBadInput);
}

/** The number of frames is written when the recording ends. */
TEST_F(ConvertKlg, framesBehindTheNumberAreTold)
{
    std::string bytes = log(3, true);
    bytes[0] = 0;
    EXPECT_EQ(convert(bytes), kExitIncomplete);
    EXPECT_THAT(text_, HasSubstr("tells no number of frames"));
    EXPECT_EQ(frames().size(), 3U);
    EXPECT_EQ(convert(bytes.substr(0, bytes.size() - 1)), kExitIncomplete);
    EXPECT_THAT(text_, HasSubstr("truncated or damaged in frame 2\n"));
    EXPECT_EQ(frames().size(), 2U);
    bytes[0] = 2;
    EXPECT_EQ(convert(bytes), kExitIncomplete);
    EXPECT_THAT(text_, HasSubstr("goes on behind the 2 frames"));
    EXPECT_EQ(frames().size(), 2U);
    EXPECT_EQ(convert(std::string(4, '\0')), kExitBadInput);
}

TEST_F(ConvertKlg, stampsInAnotherUnitAreRefused)
{
    EXPECT_EQ(convert(log(4, true, 1'500'000'000'000'000'000, 33'333'333)), kExitBadInput);
    EXPECT_THAT(
        text_,
        HasSubstr("in.klg: frames are 33.3 s apart; are stamps in nanoseconds? They must be in "
                  "microseconds\n"));
    EXPECT_EQ(convert(log(4, true, 5000, 33)), kExitBadInput);
    EXPECT_THAT(text_, HasSubstr("frames are 3.3e-05 s apart; are stamps in milliseconds?"));
    EXPECT_EQ(convert(log(1, true, 1'500'000'000'000'000'000, 0)), kExitBadInput);
    EXPECT_THAT(
        text_,
        HasSubstr("in.klg: frame 0: stamp 1500000000000000000 is not between 1970 and 2286; are "
                  "stamps in nanoseconds?"));
    EXPECT_EQ(convert(log(1, true, std::numeric_limits<std::int64_t>::min(), 0)), kExitBadInput);
    EXPECT_THAT(text_, HasSubstr("stamp -9223372036854775808 is not between"));
    EXPECT_FALSE(std::filesystem::exists(out_));
    EXPECT_EQ(convert(log(4, true, 1'500'000'000'000'000, 1'000'000)), kExitOk) << text_;
}

TEST_F(ConvertKlg, depthMayBeAlone)
{
    std::string bytes;
    append(bytes, std::int32_t{2});
    for (int i = 0; i < 2; ++i)
    {
        const std::string depth = bytesOf(test::depthImage(i));
        append(bytes, std::int64_t{5000000 + 33333 * i});
        append(bytes, static_cast<std::int32_t>(depth.size()));
        append(bytes, std::int32_t{0});
        bytes += depth;
    }
    ASSERT_EQ(convert(bytes), kExitOk) << text_;
    ASSERT_EQ(frames().size(), 2U);
    EXPECT_TRUE(frames()[1].gray.empty());
    EXPECT_NEAR(frames()[1].depth.at<float>(20, 30), 1.001, 1e-6);
}

TEST_F(ConvertKlg, framesWithoutTimesAreRefused)
{
    std::string bytes = log(3, true);
    const std::size_t size = log(2, true).size() - log(1, true).size();
    for (std::size_t i = 0; i < 3; ++i)
    {
        std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(4 + i * size), 8, '\0');
    }
    EXPECT_EQ(convert(bytes), kExitBadInput);
    EXPECT_THAT(text_, HasSubstr("first frames have the same stamp"));
}

/** A decoder would show what is missing in grey. */
TEST_F(ConvertKlg, aCutPictureIsLeftOut)
{
    const std::string whole = log(1, true);
    std::int32_t depthSize = 0, colourSize = 0;
    std::memcpy(&depthSize, &whole[12], 4);
    std::memcpy(&colourSize, &whole[16], 4);
    colourSize -= 20;
    std::string bytes = log(2, true);
    std::memcpy(&bytes[16], &colourSize, 4);
    bytes.erase(whole.size() - 20, 20);
    EXPECT_EQ(convert(bytes), kExitIncomplete);
    EXPECT_THAT(text_, HasSubstr("frame 0: colour: stops before the end of the image"));
    EXPECT_EQ(frames().size(), 1U);
}

TEST_F(ConvertKlg, damagedFramesAreLeftOut)
{
    const std::string one = log(1, true);
    std::string bytes = log(3, true);
    for (std::size_t i = 0; i < 30; ++i)
    {
        bytes[one.size() + 18 + i] = '\x55';  // the depth of frame 1
    }
    EXPECT_EQ(convert(bytes), kExitIncomplete);
    EXPECT_THAT(text_, HasSubstr("frame 1: depth"));
    EXPECT_EQ(frames().size(), 2U);
    // A size that cannot be: no going on.
    bytes = log(3, true);
    bytes[one.size() + 8 + 3] = '\x7f';
    EXPECT_EQ(convert(bytes), kExitIncomplete);
    EXPECT_EQ(frames().size(), 1U);
}
}  // namespace pointplane
