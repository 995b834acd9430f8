// SPDX-License-Identifier: BSD-3-Clause
// make_fuzz_corpus CONFIG.ini FOLDER: valid inputs for each fuzzer, FOLDER/<fuzzer>/*.
#include <pointplane/mrpt_io/RawlogWriter.h>
#include <pointplane/simulation/SimulatedSequence.h>

#include <mrpt/io/CFileOutputStream.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <mrpt/serialization/CArchive.h>

#include <cmath>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <string>

#include "frame_records.h"
#include "rawlog_samples.h"
#include <zlib.h>

namespace
{
using namespace pointplane;
using fuzzing::FrameRecord;
using fuzzing::ScanRecord;
namespace fs = std::filesystem;

constexpr int kWidth = 64, kHeight = 48, kFrames = 3;

void save(const fs::path& path, const std::string& bytes)
{
    std::ofstream file(path, std::ios::binary);
    file << bytes;
    if (!file.flush())
    {
        throw std::runtime_error("cannot write " + path.string());
    }
}

template <class Record>
void append(std::string& bytes, const Record& record)
{
    bytes.append(reinterpret_cast<const char*>(&record), sizeof(record));
}

void append(std::string& bytes, const cv::Mat& image)
{
    const cv::Mat whole = image.isContinuous() ? image : image.clone();
    bytes.append(reinterpret_cast<const char*>(whole.data), whole.total() * whole.elemSize());
}

SimulatedSequence sequenceOf(const std::string& scene)
{
    SimulationParams params;
    params.width = kWidth;
    params.height = kHeight;
    return {scene, params, 1};
}

/** Frames of a scene; the first byte chooses the configuration. */
void writeFrames(const fs::path& folder, const std::string& scene)
{
    const SimulatedSequence sequence = sequenceOf(scene);
    for (const char configuration : {'\0', '\1', '\2', '\4', '\10'})
    {
        std::string bytes(1, configuration);
        for (int i = 0; i < kFrames; ++i)
        {
            const RgbdFrame frame = sequence.frame(i);
            const PinholeCamera& camera = frame.camera;
            FrameRecord record{};
            record.stamp = frame.stamp;
            record.fx = camera.fx;
            record.fy = camera.fy;
            record.cx = camera.cx;
            record.cy = camera.cy;
            record.width = kWidth;
            record.height = kHeight;
            record.flags = FrameRecord::HasGray;
            cv::Mat depth = frame.depth;
            if (i == 1)
            {
                record.flags |= FrameRecord::DepthIsFloat | FrameRecord::HasShutter;
            }
            else
            {
                depth.setTo(0, depth != depth);  // NaN
                depth.convertTo(depth, CV_16UC1, 1 / fuzzing::kDepthStep);
            }
            append(bytes, record);
            append(bytes, frame.gray);
            append(bytes, depth);
        }
        save(folder / (scene + std::to_string(int{configuration})), bytes);
    }
}

void writeObservations(const fs::path& folder)
{
    const SimulatedSequence sequence = sequenceOf("corner");
    for (const bool registered : {true, false})
    {
        std::string bytes;
        for (int i = 0; i < kFrames; ++i)
        {
            const RgbdFrame frame = sequence.frame(i);
            ScanRecord record{};
            record.stamp_100ns = 100000000LL + 333333LL * i;
            auto& camera = record.intensityCamera;
            camera = {
                frame.camera.fx,
                frame.camera.fy,
                frame.camera.cx,
                frame.camera.cy,
                {},
                1,
                kWidth,
                kHeight,
                {}};
            record.depthCamera = camera;
            record.intensityPose[3] = record.intensityPose[5] = -M_PI / 2;
            if (!registered)
            {
                camera.distortion[0] = 0.1;
                record.depthCamera.fx += 3;
                record.intensityPose[1] = -0.025;
                record.sensorPose[2] = 1;
            }
            record.rangeUnits = 0.001F;
            record.rangeWidth = record.intensityWidth = kWidth;
            record.rangeHeight = record.intensityHeight = kHeight;
            record.flags = ScanRecord::HasIntensity | ScanRecord::HasRange;
            cv::Mat millimetres = frame.depth;
            millimetres.setTo(0, millimetres != millimetres);  // NaN
            millimetres.convertTo(millimetres, CV_16UC1, 1000);
            append(bytes, record);
            append(bytes, frame.gray);
            append(bytes, millimetres);
        }
        save(folder / (registered ? "registered" : "unregistered"), bytes);
    }
}

/** Everything that a robot's rawlog may hold besides. */
void writeOtherSensors(const std::string& path)
{
    mrpt::io::CFileOutputStream file(path);
    auto archive = mrpt::serialization::archiveFrom(file);
    for (const auto& object : test::otherSensors())
    {
        archive << *object;
    }
    mrpt::obs::CObservationComment comment;
    comment.text = "pointplane-camera label=RGBD readoutColour=0.02";
    mrpt::obs::CObservationRobotPose pose;
    pose.pose.cov.setIdentity();
    archive << comment << pose;
}

/** A rawlog in both formats, compressed and plain, and each way that a scan can be stored. */
void writeRawlogs(const fs::path& folder)
{
    RawlogWriterOptions stored;
    stored.compressionLevel = 0;
    test::writeObservations(folder / "observations", 2);
    test::writeObservations(folder / "observations_stored", 2, stored);
    test::writeActionsAndFrames(folder / "frames", 2);
    writeOtherSensors(folder / "other_sensors");
    const auto writePlain = [&folder](const char* name, const auto& change)
    {
        const auto scan = test::sampleScan(0, 8, 6);
        change(*scan);
        mrpt::io::CFileOutputStream file((folder / name).string());
        mrpt::serialization::archiveFrom(file) << *scan;
    };
    using Scan = mrpt::obs::CObservation3DRangeScan;
    writePlain("plain", [](Scan&) {});
    writePlain("gray", [](Scan& s) { s.intensityImage = s.intensityImage.grayscale(); });
    writePlain("external", [](Scan& s) { s.intensityImage.setExternalStorage("a.png"); });
    writePlain(
        "points",
        [](Scan& s)
        {
            s.hasPoints3D = true;
            s.resizePoints3DVectors(3);
        });
    writePlain(
        "layers_and_labels",
        [](Scan& s)
        {
            s.rangeImageOtherLayers["second"].setSize(6, 8);
            s.pixelLabels = std::make_shared<mrpt::obs::TPixelLabelInfo<2>>();
            s.pixelLabels->setSize(6, 8);
            s.pixelLabels->setLabelName(3, "wall");
        });
    mrpt::img::CImage::DISABLE_JPEG_COMPRESSION(false);
    writePlain("jpeg", [](Scan&) {});
}

/** A map as pointplane-odometry writes it, plain and compressed. */
void writeSimplemaps(const fs::path& folder)
{
    mrpt::maps::CSimpleMap map;
    mrpt::poses::CPose3DPDFGaussian pose;
    pose.cov.setIdentity();
    for (int k = 0; k < 2; ++k)
    {
        mrpt::obs::CSensoryFrame frame;
        frame.insert(test::sampleScan(k, 8, 6));
        map.insert(pose, frame);
    }
    map.saveToFile((folder / "compressed").string());
    mrpt::io::CFileOutputStream file((folder / "plain").string());
    mrpt::serialization::archiveFrom(file) << map;
}

void writeTexts(const fs::path& folder)
{
    const std::string tum =
        "# timestamp tx ty tz qx qy qz qw\n"
        "1305031102.1758 1.3405 0.6266 1.6575 0.6574 0.6126 -0.2949 -0.3248\n"
        "1305031102.2758 1.3303 0.6256 1.6464 0.6579 0.6161 -0.2932 -0.3189\n";
    save(folder / "tum", tum);
    save(
        folder / "tum_left_out",
        tum + "3 nan 0 0 0 0 0 1\n4,0,0,0,0,0,0,0\n\n3 1e3 -2 +1 0 0 0 2\n");
    save(
        folder / "mrpt", "% time x y z yaw pitch roll\n1 2 3 4 0.1 0.2 0.3\n2 2 3 4 0.1 0.2 0.3\n");
    save(folder / "listing", "# stamp file\n1305031102.175304 rgb/1.png\n1305031102.2 rgb/2.png\n");
}

/** Two frames of 8 x 6 pixels, plain and with zlib. */
void writeKlgLogs(const fs::path& folder)
{
    const std::string depth(8 * 6 * 2, '\x05'), colour(8 * 6 * 3, '\x40');
    uLongf length = compressBound(depth.size());
    std::string compressed(length, 0);
    compress(
        reinterpret_cast<Bytef*>(compressed.data()),
        &length,
        reinterpret_cast<const Bytef*>(depth.data()),
        depth.size());
    compressed.resize(length);
    for (const std::string& block : {depth, compressed})
    {
        std::string log;
        append(log, std::int32_t{2});
        for (std::int64_t microseconds : {5000000, 5033333})
        {
            append(log, microseconds);
            append(log, static_cast<std::int32_t>(block.size()));
            append(log, static_cast<std::int32_t>(colour.size()));
            log += block + colour;
        }
        save(folder / (std::to_string(block.size())), log);
    }
}

/** Each layout that `pointplane-convert folder` and `tum` know (folder_archive.h). */
void writeFolders(const fs::path& folder)
{
    const std::string camera = ">>camera.txt\n8 8 3.5 2.5 0 0 0 0 0 8 6 1000\n";
    const auto images = [](const std::string& colour, const std::string& depth)
    { return ">>" + colour + " @c\n>>" + depth + " @d\n"; };
    const std::string numbered = images("rgb/1.png", "depth/1.png") +
                                 images("rgb/2.png", "depth/2.png") + ">>rgb/3.png @g\n" +
                                 ">>depth/3.png @a\n";
    save(folder / "numbered", numbered + camera);
    save(
        folder / "stamped",
        images("rgb/1305031102.1753.png", "depth/1305031102.1604.png") +
            images("rgb/1305031102211214.png", "depth/1305031102.2.png") + camera);
    save(
        folder / "tum",
        numbered + camera +
            ">>rgb.txt\n# stamp file\n1.1 rgb/1.png\n1.2 rgb/2.png\n>>depth.txt\n1.11 "
            "depth/1.png\n1.21 depth/2.png\n1.3 depth/3.png\n>>groundtruth.txt\n1.1 0 0 0 0 0 0 "
            "1\n");
    const std::string matrix = "8 0 3.5 0\n0 8 2.5 0\n0 0 1 0\n0 0 0 1\n";
    save(
        folder / "scannet",
        images("color/0.jpg", "depth/0.png") + ">>depth/1.png @s\n>>color/1.jpg @j\n" +
            ">>intrinsic/intrinsic_color.txt\n" + matrix + ">>intrinsic/intrinsic_depth.txt\n" +
            matrix);
    save(folder / "7scenes", images("frame-000000.color.png", "frame-000000.depth.png") + camera);
    save(
        folder / "redwood",
        images("image/0000001-000000033369.jpg", "depth/0000001-000000033369.png") + camera +
            ">>trajectory.log\n0 0 1\n1 0 0 0.5\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
    save(
        folder / "stamped_truth",
        images("rgb/1548266470.5.png", "depth/1548266470.5.png") + camera +
            ">>groundtruth.txt\n1548266470.5 1 2 3 0 0 0 1\n");
    save(
        folder / "replica",
        images("results/frame000000.jpg", "results/depth000000.png") +
            ">>cam_params.json\n{\"camera\": {\"w\": 8, \"h\": 6, \"fx\": 8, \"fy\": 8, \"cx\": "
            "3.5, \"cy\": 2.5, \"scale\": 6553.5}}\n");
    save(
        folder / "record3d",
        ">>rgb/0.jpg @j\n>>depth/0.tiff @f\n>>rgb/1.jpg @j\n>>depth/1.png @s\n" +
            std::string(">>metadata.json\n{\"w\": 16, \"h\": 12, \"fps\": 60, \"K\": [16, 0, 0, 0, "
                        "16, 0, 7.5, 5.5, 1], \"frameTimestamps\": [0.1, 0.2], "
                        "\"poses\": [[0, 0, 0, 1, 0, 0, 0], [0, 0, 0, 1, 1, 2, 3]]}\n"));
    save(
        folder / "open3d",
        images("color/0.jpg", "depth/0.png") +
            ">>intrinsic.json\n{\"width\": 8, \"height\": 6, \"fps\": 15, \"depth_scale\": 1000, "
            "\"intrinsic_matrix\": [8, 0, 0, 0, 8, 0, 3.5, 2.5, 1]}\n");
    save(
        folder / "stray",
        images("rgb/0.png", "depth/000000.png") +
            ">>camera_matrix.csv\n8,0,3.5\n0,8,2.5\n0,0,1\n>>odometry.csv\n"
            "timestamp, frame, x, y, z, qx, qy, qz, qw\n5.5, 000000, 1, 2, 3, 0, 0, 0, 1\n");
}

fs::path newFolder(const fs::path& parent, const char* name)
{
    fs::create_directories(parent / name);
    return parent / name;
}
}  // namespace

int main(int argc, char** argv)
{
    if (argc != 3)
    {
        std::cerr << "usage: make_fuzz_corpus CONFIG.ini FOLDER\n";
        return 2;
    }
    try
    {
        const fs::path root = argv[2];
        writeRawlogs(newFolder(root, "rawlog"));
        writeSimplemaps(newFolder(root, "simplemap"));
        writeTexts(newFolder(root, "text"));
        writeKlgLogs(newFolder(root, "klg"));
        writeFolders(newFolder(root, "folder"));
        fs::copy_file(
            argv[1], newFolder(root, "ini") / "config", fs::copy_options::overwrite_existing);
        save(root / "ini" / "short", "[DepthNoise]\nsigmaPixelPx = 0.7 // px\n");
        for (const char* scene : {"corner", "desk"})
        {
            writeFrames(newFolder(root, "frames"), scene);
        }
        writeObservations(newFolder(root, "observations"));
    }
    catch (const std::exception& error)
    {
        std::cerr << "error: " << error.what() << "\n";
        return 1;
    }
    return 0;
}
