// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

#include <string>
#include <vector>

namespace pointplane
{
/** Reads an image file. A PNG's checksums and the end of a JPEG are verified first, because
 * decoders fill what is missing with grey, or complain on the terminal. Pixels stay where they are
 * stored: an orientation in EXIF data does not turn the image, as it does not turn depth and
 * calibration. \param flags of cv::imread
 * \throws InputError naming the file, or the folder that is missing */
[[nodiscard]] cv::Mat readImageFile(const std::string& path, int flags);

/** The same for the bytes of a file. \param name of them, for errors */
[[nodiscard]] cv::Mat decodedImage(
    const std::vector<unsigned char>& bytes, int flags, const std::string& name);

/** Reads a mask for Odometry::setMask(). \return withoutRobot() of it
 * \throws InputError naming the file, also for what withoutRobot() refuses */
[[nodiscard]] cv::Mat readMask(const std::string& path);

/** \param path of the mask \param images their size \param label of their camera
 * \throws InputError naming the file if the mask has another size than the images */
void requireMaskSize(
    const std::string& path, cv::Size mask, cv::Size images, const std::string& label);

/** Writes the whole file (OutputFile), or leaves an earlier one as it was. \param options of
 * cv::imwrite \throws EnvironmentError naming the file */
void writeImageFile(
    const std::string& path, const cv::Mat& image, const std::vector<int>& options = {});

/** The same as JPEG, without OpenCV's coders. \param bgr CV_8UC3 \param quality 1 to 100
 * \throws std::invalid_argument for another image or quality */
void writeJpegFile(const std::string& path, const cv::Mat& bgr, int quality);
}  // namespace pointplane
