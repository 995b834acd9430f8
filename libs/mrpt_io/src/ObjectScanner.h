// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include "GzInput.h"

namespace pointplane
{
/** Copies one serialised MRPT object from a file into memory, checking every length field on the
 * way.
 *
 * MRPT allocates what a length field says, unchecked: a flipped bit means gigabytes or a crash. The
 * scanner's buffer grows only as bytes arrive. It knows the layout of the classes of RGB-D rawlogs
 * (observations, poses, images, frames and actions, in the versions listed in the source) and of
 * the sensors that robots commonly log beside. Objects of other classes and versions are Unknown.
 */
class ObjectScanner
{
 public:
    /** Why an object could not be copied; the text is one clause. */
    class Problem : public std::runtime_error
    {
     public:
        using std::runtime_error::runtime_error;
    };

    /** A class or version whose layout is not known here: no sign of damage. */
    class Unknown : public Problem
    {
     public:
        using Problem::Problem;
    };

    /** Written before MRPT 0.5.5, or no object at all. */
    class OldFormat : public Problem
    {
     public:
        using Problem::Problem;
    };

    /** What a range scan says about its depth camera. MRPT replaces it by the size of the range
     * image while reading, which hides intrinsics of another resolution. */
    struct Resolution
    {
        std::uint32_t rows{0}, cols{0};
    };

    explicit ObjectScanner(GzInput& in) : in_(in) {}

    /** Copies the next object, as MRPT shall see it: JPEG images decoded, resolutions exchanged.
     * False if the input ended before its first byte.
     * \throws Problem, Unknown; the bytes so far are in `bytes` then */
    bool scan(std::vector<std::uint8_t>& bytes);

    /** @name A CSimpleMap, piece by piece: it may be larger than memory. Between its start and its
     * end are, for each key frame, two objects (the pose and the sensory frame) and, since version
     * 2, a twist.
     * \throws Problem, Unknown
     * @{ */
    struct MapStart
    {
        int version{0};
        bool isOld{false};  //!< OldFormat
        std::uint32_t numKeyFrames{0};
    };
    MapStart scanMapStart(std::vector<std::uint8_t>& bytes);
    void scanTwist(std::vector<std::uint8_t>& bytes);
    void scanMapEnd(const MapStart& map, std::vector<std::uint8_t>& bytes);
    /** @} */

    /** Puts the file's own bytes back into the latest object. */
    void restore(std::vector<std::uint8_t>& bytes) const;

    /** Resolutions of the depth cameras in the file, one per range scan in the object, in order. In
     * the copied bytes, the size of the range image stands in their place. */
    [[nodiscard]] const std::vector<Resolution>& cameraResolutions() const { return resolutions_; }

 private:
    struct Header
    {
        std::string className;  //!< without namespace
        int version{0};
        std::size_t begin{0};  //!< of the object in the buffer
    };

    void begin(std::vector<std::uint8_t>& bytes);

    // Primitives: copy and return.
    void copy(std::uint64_t size);
    template <class T>
    T copyValue();
    bool copyBool();
    void copyString();
    void copyArray(std::uint64_t count, std::uint64_t elementSize);

    Header copyHeader();
    Header copyOldHeader();
    std::string copyClassName(std::size_t size);
    void copyBody(const Header& header, int depth);
    void copyObject(const char* expectedClass);
    void copyAnyObject(int depth);
    void copyObjects(int depth);
    void copyEndFlag(const Header& header);

    // Bodies, each named after its class.
    void sensoryFrame(int version, int depth);
    void movement3D();
    void robotPose();
    void comment(int version);
    void range3DScan(int version);
    void rangeImage();
    void exchangeResolution(const Resolution& range);
    void pixelLabels();
    void image(int version);
    void grayPixels(int version);
    void colourPixels(std::size_t versionAt, int version);
    void jpegPixels(std::size_t versionAt, std::int32_t width, std::int32_t height);
    void camera(int version);
    void pose3D(int version);

    /** Objects inside of those above. False when the class is none of them. */
    bool partOfOthers(const Header& header);

    /** False when the class is none of them. */
    bool otherSensor(const Header& header, int depth);
    void rangeScan2D(int version);
    void imu(int version);
    void wheelOdometry();
    void movement2D(int depth);
    void velocities();
    void wheels();

    /** What was put in place of the file's bytes. */
    struct Edit
    {
        std::size_t at{0}, size{0};
        std::vector<std::uint8_t> original;
    };
    void noteEdit(std::size_t at, std::size_t originalSize, std::size_t size);

    GzInput& in_;
    std::vector<std::uint8_t>* bytes_{nullptr};
    std::vector<Edit> edits_;
    std::vector<Resolution> resolutions_;
    std::size_t cameraResolutionAt_{0};  // in the buffer, of the latest camera
};
template <class T>
T ObjectScanner::copyValue()
{
    copy(sizeof(T));
    T value;
    std::memcpy(&value, bytes_->data() + bytes_->size() - sizeof(T), sizeof(T));
    return value;
}

/** What the layouts of all classes are checked with. */
namespace scanning
{
constexpr std::uint64_t kMaxPixels = 1ULL << 26U;  // 8192 x 8192

inline void require(bool condition, const std::string& problem)
{
    if (!condition)
    {
        throw ObjectScanner::Problem(problem);
    }
}

/** For what MRPT may know better. */
inline void requireKnown(bool condition, const std::string& what)
{
    if (!condition)
    {
        throw ObjectScanner::Unknown(what);
    }
}

inline std::uint64_t numPixels(std::uint64_t width, std::uint64_t height)
{
    require(
        width <= kMaxPixels && height <= kMaxPixels && width * height <= kMaxPixels,
        "an image of " + std::to_string(width) + "x" + std::to_string(height) + " pixels");
    return width * height;
}
}  // namespace scanning
}  // namespace pointplane
