// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/number_text.h>
#include <pointplane/mrpt_io/ObservationConverter.h>
#include <pointplane/mrpt_io/RawlogReader.h>
#include <pointplane/mrpt_io/ScanWriter.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/mrpt_poses.h>
#include <pointplane/mrpt_io/params_ini.h>
#include <pointplane/odometry/Odometry.h>

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <deque>
#include <exception>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <sstream>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <cxxabi.h>
#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <unistd.h>

namespace py = pybind11;

namespace pointplane
{
namespace
{
/** A text for Python. Names of files and what ini files hold may be in any coding; bytes that are
 * not UTF-8 are shown as \\xe9. */
py::str textOf(const std::string& text)
{
    PyObject* const decoded = PyUnicode_DecodeUTF8(
        text.data(), static_cast<py::ssize_t>(text.size()), "backslashreplace");
    if (decoded == nullptr)
    {
        throw py::error_already_set();
    }
    return py::reinterpret_steal<py::str>(decoded);
}

[[noreturn]] void refuseType(const py::array& array, const std::string& expected)
{
    throw py::type_error(
        expected + "; it is " + py::cast<std::string>(py::str(py::object(array.dtype()))));
}

/** Whether it holds numbers of this type. A pickled array, or one with metadata, has a dtype object
 * of its own. \param fill what a masked element should be, for the message */
template <class T>
bool isOf(const py::array& array, const char* what, const char* fill)
{
    if (py::isinstance(array, py::module_::import("numpy.ma").attr("MaskedArray")))
    {
        throw py::type_error(
            std::string(what) + ": is a masked array, whose mask is not read; give " + what +
            ".filled(" + fill + ")");
    }
    return array.dtype().equal(py::dtype::of<T>());
}

/** An image in NumPy's memory; rows have to be contiguous. */
cv::Mat matOf(const py::array& array, int type, const char* what)
{
    const bool colour = CV_MAT_CN(type) > 1;
    const auto itemSize = static_cast<py::ssize_t>(CV_ELEM_SIZE(type));
    if (array.ndim() != (colour ? 3 : 2) || (colour && array.shape(2) != CV_MAT_CN(type)))
    {
        throw py::value_error(
            std::string(what) + ": has the shape " +
            py::cast<std::string>(py::str(array.attr("shape"))) + ", not (height, width" +
            (colour ? ", 3)" : ")"));
    }
    if (array.size() == 0)
    {
        throw py::value_error(std::string(what) + ": is empty");
    }
    const auto rowGap = array.strides(0) - array.shape(1) * itemSize;
    if (array.strides(1) != itemSize || (colour && array.strides(2) != 1) || rowGap < 0 ||
        rowGap % (itemSize / CV_MAT_CN(type)) != 0)
    {
        throw py::value_error(
            std::string(what) + ": rows are not contiguous; give numpy.ascontiguousarray(" + what +
            ")");
    }
    return {
        static_cast<int>(array.shape(0)),
        static_cast<int>(array.shape(1)),
        type,
        const_cast<void*>(array.data()),
        static_cast<std::size_t>(array.strides(0))};
}

/** float32 in metres as it is; integers times the unit, zero and kSaturatedDepth = no reading. */
cv::Mat depthOf(const py::array& depth, std::optional<double> givenUnit)
{
    if (isOf<float>(depth, "depth", "numpy.nan), or of integers depth.filled(0"))
    {
        if (givenUnit)
        {
            throw py::value_error(
                "depth_unit: is of uint16, but this depth is float32, and such depth is in metres");
        }
        return matOf(depth, CV_32FC1, "depth");
    }
    if (!isOf<std::uint16_t>(depth, "depth", "0"))
    {
        refuseType(depth, "depth: expected float32 in metres, or uint16 in units of depth_unit");
    }
    const double unit = givenUnit.value_or(0.001);
    if (!problemOfDepthUnits(1 / unit).empty())
    {
        std::ostringstream out;
        out << "depth_unit: is " << unit << " m, not from " << 1 / kMostDepthUnits << " to "
            << 1 / kLeastDepthUnits << " m; 0.001 means millimetres";
        throw py::value_error(out.str());
    }
    const cv::Mat readings = matOf(depth, CV_16UC1, "depth");
    cv::Mat metres;
    readings.convertTo(metres, CV_32FC1, unit);
    metres.setTo(
        std::numeric_limits<float>::quiet_NaN(), (readings == 0) | (readings == kSaturatedDepth));
    return metres;
}

/** Gray as it is; RGB is converted. \param meaning of its numbers */
cv::Mat grayOf(const py::object& colour, const char* name, const std::string& meaning)
{
    if (colour.is_none())
    {
        return {};
    }
    const std::string expected = std::string(name) + ": expected uint8, " + meaning;
    if (!py::isinstance<py::array>(colour))
    {
        // NumPy would make an array of it, which nobody keeps while its memory is used.
        throw py::type_error(
            expected + "; it is " + py::cast<std::string>(py::type::of(colour).attr("__name__")));
    }
    const auto array = py::reinterpret_borrow<py::array>(colour);
    if (!isOf<std::uint8_t>(array, name, "0"))
    {
        refuseType(array, expected);
    }
    if (array.ndim() == 2)
    {
        return matOf(array, CV_8UC1, name);
    }
    cv::Mat gray;
    cv::cvtColor(matOf(array, CV_8UC3, name), gray, cv::COLOR_RGB2GRAY);
    return gray;
}

std::vector<std::string> settingsOf(const py::object& settings)
{
    try
    {
        return settings.cast<std::vector<std::string>>();
    }
    catch (const py::cast_error&)
    {
        throw py::type_error("settings: expected a list like ['Lens.nominal=true']");
    }
}

/** The image's memory as an array that keeps it. */
template <class T>
py::object arrayOf(const cv::Mat& image)
{
    if (image.empty())
    {
        return py::none();
    }
    auto* const owner = new cv::Mat(image);
    const py::capsule keeper(owner, [](void* mat) { delete static_cast<cv::Mat*>(mat); });
    return py::array_t<T>(
        {static_cast<py::ssize_t>(image.rows), static_cast<py::ssize_t>(image.cols)},
        {static_cast<py::ssize_t>(image.step[0]), static_cast<py::ssize_t>(sizeof(T))},
        owner->ptr<T>(),
        keeper);
}

/** While it lives, other threads of Python run. If Python ends meanwhile, as under a daemon thread,
 * this thread stops here. Python would unwind it, and end the program on the way through C++. */
class WithoutPython
{
 public:
    WithoutPython() : state_(PyEval_SaveThread()) {}
    ~WithoutPython()
    {
        try
        {
            PyEval_RestoreThread(state_);
        }
        catch (const abi::__forced_unwind&)
        {
            while (true)
            {
                ::pause();
            }
        }
    }
    WithoutPython(const WithoutPython&) = delete;
    WithoutPython& operator=(const WithoutPython&) = delete;

 private:
    PyThreadState* state_;
};

/** The frames of one camera of a rawlog. Python's threads may share it. */
class RawlogFrames
{
 public:
    /** \param label empty: the first frame's */
    RawlogFrames(const std::string& path, std::string label) : reader_(path)
    {
        if (!label.empty())
        {
            label_ = std::move(label);
        }
        converter_.setExternalsDirectory(reader_.externalsDirectory());
    }

    /** \return nothing at the end */
    [[nodiscard]] std::optional<ConvertedFrame> next()
    {
        // In this order: who waits for a frame of another thread must not hold up Python.
        const WithoutPython others;
        const std::lock_guard lock(mutex_);
        while (true)
        {
            while (!pending_.empty())
            {
                const auto observation = pending_.front();
                pending_.pop_front();
                if (const auto* comment =
                        dynamic_cast<const mrpt::obs::CObservationComment*>(observation.get()))
                {
                    readComment(*comment);
                }
                const auto* scan =
                    dynamic_cast<const mrpt::obs::CObservation3DRangeScan*>(observation.get());
                if (scan == nullptr)
                {
                    continue;
                }
                label_ = label_.value_or(scan->sensorLabel);
                ++framesOf_[scan->sensorLabel];
                if (scan->sensorLabel == label_)
                {
                    return converter_.convert(*scan);
                }
            }
            const auto object = reader_.next();
            if (!object)
            {
                if (!reader_.ending().message.empty())
                {
                    throw InputError(reader_.ending().message);
                }
                requireFrames();
                return {};
            }
            if (auto observation = std::dynamic_pointer_cast<mrpt::obs::CObservation>(object))
            {
                pending_.push_back(observation);
            }
            else if (auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(object))
            {
                pending_.insert(pending_.end(), frame->begin(), frame->end());
            }
        }
    }

 private:
    /** \throws InputError naming the file */
    void readComment(const mrpt::obs::CObservationComment& comment)
    {
        try
        {
            converter_.readComment(comment);
        }
        catch (const InputError& e)
        {
            throw InputError(reader_.path() + ": " + e.what());
        }
    }

    /** A label that no camera has is a mistake, not a camera without frames. */
    void requireFrames() const
    {
        if (framesOf_.empty())
        {
            throw InputError(reader_.path() + ": no CObservation3DRangeScan in it");
        }
        if (framesOf_.count(*label_) > 0)
        {
            return;
        }
        std::string there;
        for (const auto& [label, count] : framesOf_)
        {
            there += (there.empty() ? "" : ", ") + std::to_string(count) + " of '" + label + "'";
        }
        throw InputError(
            reader_.path() + ": no frames of camera '" + *label_ + "'; in it are " + there);
    }

    std::mutex mutex_;
    RawlogReader reader_;
    ObservationConverter converter_;
    std::deque<mrpt::obs::CObservation::Ptr> pending_;
    std::optional<std::string> label_;
    std::map<std::string, std::size_t> framesOf_;
};

/** An odometry that Python's threads may share: one frame after the other. */
class SharedOdometry
{
 public:
    explicit SharedOdometry(const OdometryParams& params) : odometry_(params) {}

    [[nodiscard]] OdometryResult process(const RgbdFrame& frame)
    {
        // In this order, as in RawlogFrames.
        const WithoutPython others;
        const std::lock_guard lock(mutex_);
        return odometry_.process(frame);
    }

    [[nodiscard]] OdometryResult process(const ConvertedFrame& converted)
    {
        const WithoutPython others;
        const std::lock_guard lock(mutex_);
        const ConvertedFrame own = ofOneCamera(converted, label_);
        OdometryResult result = odometry_.process(own.frame);
        if (!own.problem.empty())
        {
            result.reason = own.problem;
        }
        return result;
    }

    void setMask(const cv::Mat& mask)
    {
        const WithoutPython others;
        const std::lock_guard lock(mutex_);
        odometry_.setMask(mask);
    }

    void reset()
    {
        const WithoutPython others;
        const std::lock_guard lock(mutex_);
        odometry_.reset();
        label_.reset();
    }

 private:
    std::mutex mutex_;
    Odometry odometry_;
    std::optional<std::string> label_;  //!< of the first frame of a rawlog
};

template <class T>
constexpr bool kIsOfModule =
    std::is_same_v<T, PinholeCamera> || std::is_same_v<T, OdometryResult> ||
    std::is_same_v<T, ConvertedFrame> || std::is_same_v<T, SharedOdometry> ||
    std::is_same_v<T, RawlogFrames>;
}  // namespace
}  // namespace pointplane

/** Of an object whose __init__() never ran, as Frame.__new__(Frame), pybind11 (2.10) would use
 * memory that nobody initialised. */
template <class T>
struct pybind11::detail::type_caster<T, std::enable_if_t<pointplane::kIsOfModule<T>>>
    : type_caster_base<T>
{
    bool load(handle source, bool convert)
    {
        if (isinstance<T>(source) &&
            reinterpret_cast<instance*>(source.ptr())->get_value_and_holder().value_ptr() ==
                nullptr)
        {
            throw type_error(
                cast<std::string>(str(type::of(source).attr("__name__"))) +
                ": its __init__() was not called");
        }
        return type_caster_base<T>::load(source, convert);
    }
};

namespace pointplane
{
namespace
{
/** \param given numbers, an array of any shape (OpenCV's is 1x5), or None for no distortion
 * \throws value_error for more than is known here */
std::array<double, 5> distortionOf(const py::object& given)
{
    std::array<double, 5> out{};
    if (given.is_none())
    {
        return out;
    }
    std::vector<double> values;
    try
    {
        values = (py::hasattr(given, "ravel") ? given.attr("ravel")() : given)
                     .cast<std::vector<double>>();
    }
    catch (const py::cast_error&)
    {
        throw py::type_error("distortion: expected numbers k1 k2 p1 p2 k3, as OpenCV, or None");
    }
    const auto known = values.begin() + static_cast<long>(std::min(values.size(), out.size()));
    if (std::any_of(known, values.end(), [](double value) { return value != 0; }))
    {
        throw py::value_error(
            "distortion has " + std::to_string(values.size()) +
            " values, but only k1 k2 p1 p2 k3 are known: undistort the images first");
    }
    std::copy(values.begin(), known, out.begin());
    return out;
}

void addCamera(py::module_& m)
{
    py::class_<PinholeCamera>(
        m,
        "Camera",
        "Pinhole camera. Pixel (0, 0) is the centre of the top left one; distortion is k1 k2 p1 "
        "p2 k3 of OpenCV: of fewer values, the others are 0.")
        .def(
            py::init(
                [](double fx,
                   double fy,
                   double cx,
                   double cy,
                   int width,
                   int height,
                   const py::object& distortion)
                {
                    PinholeCamera camera;
                    camera.fx = fx;
                    camera.fy = fy;
                    camera.cx = cx;
                    camera.cy = cy;
                    camera.width = width;
                    camera.height = height;
                    camera.distortion = distortionOf(distortion);
                    if (const std::string problem = camera.problem(); !problem.empty())
                    {
                        throw py::value_error(problem);
                    }
                    return camera;
                }),
            py::arg("fx"),
            py::arg("fy"),
            py::arg("cx"),
            py::arg("cy"),
            py::arg("width"),
            py::arg("height"),
            py::arg("distortion") = py::tuple())
        .def_readonly("width", &PinholeCamera::width)
        .def_readonly("height", &PinholeCamera::height)
        .def_readonly("fx", &PinholeCamera::fx)
        .def_readonly("fy", &PinholeCamera::fy)
        .def_readonly("cx", &PinholeCamera::cx)
        .def_readonly("cy", &PinholeCamera::cy)
        .def_readonly("distortion", &PinholeCamera::distortion)
        .def(py::pickle(
            [](const PinholeCamera& c) {
                return py::make_tuple(
                    c.fx, c.fy, c.cx, c.cy, c.width, c.height, c.distortion, c.isNominal);
            },
            [](const py::tuple& state)
            {
                PinholeCamera c;
                c.fx = state[0].cast<double>();
                c.fy = state[1].cast<double>();
                c.cx = state[2].cast<double>();
                c.cy = state[3].cast<double>();
                c.width = state[4].cast<int>();
                c.height = state[5].cast<int>();
                c.distortion = state[6].cast<std::array<double, 5>>();
                c.isNominal = state[7].cast<bool>();
                return c;
            }))
        .def(
            "__repr__",
            [](const PinholeCamera& c)
            {
                return "<pointplane.Camera " + std::to_string(c.width) + "x" +
                       std::to_string(c.height) + ", fx=" + numberText(c.fx) +
                       " fy=" + numberText(c.fy) + " cx=" + numberText(c.cx) +
                       " cy=" + numberText(c.cy) + (c.isDistorted() ? ", distorted>" : ">");
            });
}

[[nodiscard]] py::tuple stateOf(const PoseGaussian& pose)
{
    std::array<double, 16> mean{};
    std::array<double, 36> cov{};
    Eigen::Map<Eigen::Matrix4d>(mean.data()) = pose.mean.matrix();
    Eigen::Map<Matrix6d>(cov.data()) = pose.cov;
    return py::make_tuple(mean, cov);
}

[[nodiscard]] PoseGaussian poseOf(const py::tuple& state)
{
    const auto mean = state[0].cast<std::array<double, 16>>();
    const auto cov = state[1].cast<std::array<double, 36>>();
    PoseGaussian pose;
    pose.mean.matrix() = Eigen::Map<const Eigen::Matrix4d>(mean.data());
    pose.cov = Eigen::Map<const Matrix6d>(cov.data());
    return pose;
}

void addResult(py::module_& m)
{
    py::class_<OdometryResult>(
        m,
        "Result",
        "Motion of the camera's optical frame (x right, y down, z forward) up to one frame. "
        "Covariances are 6x6, of a perturbation on the left: translation [m], then rotation [rad].")
        .def_property_readonly(
            "status",
            [](const OdometryResult& r) { return toString(r.status); },
            "first, tracked, predicted or lost")
        .def_property_readonly(
            "reason",
            [](const OdometryResult& r) { return textOf(r.reason); },
            "why it was not tracked, or what limits a tracked one (directions that are predicted, "
            "an image that is left out); or empty")
        .def_readonly("stamp", &OdometryResult::stamp, "of the frame [s]; NaN: of another camera")
        .def_property_readonly(
            "pose",
            [](const OdometryResult& r) { return r.pose.mean.matrix(); },
            "4x4, this frame in the first one")
        .def_property_readonly(
            "covariance", [](const OdometryResult& r) { return r.pose.cov; }, "6x6, of the pose")
        .def_property_readonly(
            "increment",
            [](const OdometryResult& r) { return r.increment.mean.matrix(); },
            "4x4, this frame in the one before")
        .def_property_readonly(
            "increment_covariance",
            [](const OdometryResult& r) { return r.increment.cov; },
            "6x6, of this increment alone")
        .def_property_readonly(
            "since",
            [](const OdometryResult& r)
            {
                std::vector<std::pair<Eigen::Matrix4d, Matrix6d>> out;
                for (const PoseGaussian& motion : r.since)
                {
                    out.emplace_back(motion.mean.matrix(), motion.cov);
                }
                return out;
            },
            "list of (4x4, 6x6): this frame in the ones 1, 2, ... before, up to "
            "Covariance.history, with covariances")
        .def(py::pickle(  // what Python sees of it
            [](const OdometryResult& r)
            {
                py::list since;
                for (const PoseGaussian& motion : r.since)
                {
                    since.append(stateOf(motion));
                }
                return py::make_tuple(
                    static_cast<int>(r.status),
                    py::bytes(r.reason),
                    r.stamp,
                    stateOf(r.pose),
                    stateOf(r.increment),
                    since);
            },
            [](const py::tuple& state)
            {
                OdometryResult r;
                const int status = state[0].cast<int>();
                if (status < 0 || status > static_cast<int>(TrackingStatus::Lost))
                {
                    throw py::value_error("no status of a frame: " + std::to_string(status));
                }
                r.status = static_cast<TrackingStatus>(status);
                r.reason = state[1].cast<std::string>();
                r.stamp = state[2].cast<double>();
                r.pose = poseOf(state[3]);
                r.increment = poseOf(state[4]);
                for (const py::handle motion : state[5])
                {
                    r.since.push_back(poseOf(motion.cast<py::tuple>()));
                }
                return r;
            }))
        .def(
            "__repr__",
            [](const OdometryResult& r)
            {
                return textOf(
                    std::string("<pointplane.Result ") + toString(r.status) +
                    (r.reason.empty() ? "" : ": " + r.reason) + ">");
            });
}

void addOdometry(py::module_& m)
{
    py::class_<SharedOdometry>(
        m,
        "VisualOdometry",
        "One object per camera; frames in order of time. Threads that share it wait for each "
        "other.")
        .def(
            py::init(
                [](const std::filesystem::path& config, const py::object& settings)
                {
                    return std::make_unique<SharedOdometry>(
                        loadOdometryParams(config.string(), settingsOf(settings)));
                }),
            py::arg("config") = "",
            py::arg("settings") = py::tuple(),
            "config: an ini file, or empty for the defaults; settings: a list of "
            "'Section.key=value'")
        .def(
            "process",
            [](SharedOdometry& odometry,
               const py::array& depth,
               const py::object& colour,
               const PinholeCamera& camera,
               double stamp,
               std::optional<double> unit)
            {
                RgbdFrame frame;
                frame.stamp = stamp;
                frame.camera = camera;
                frame.depth = depthOf(depth, unit);
                frame.gray = grayOf(colour, "colour", "gray or RGB");
                return odometry.process(frame);
            },
            py::arg("depth"),
            py::arg("colour"),
            py::arg("camera"),
            py::arg("stamp"),
            py::arg("depth_unit") = py::none(),
            "depth: (height, width), float32 [m] with NaN for no reading, used in place; or uint16 "
            "in units of depth_unit (1e-6 to 1 m; None: 0.001) with 0 or 65535 for none. colour: "
            "registered to it, uint8, gray (used in place) or RGB, or None. stamp [s]. A frame "
            "that cannot be used is lost, with a reason, and no exception.")
        .def(
            "process",
            py::overload_cast<const ConvertedFrame&>(&SharedOdometry::process),
            py::arg("frame"),
            "A frame of a rawlog, see read_rawlog(), with its shutter. One of another camera than "
            "the first is lost.")
        .def(
            "set_mask",
            [](SharedOdometry& odometry, const py::object& mask)
            { odometry.setMask(grayOf(mask, "mask", "0 where the robot is, 1 or 255 elsewhere")); },
            py::arg("mask"),
            "Leaves out what the camera sees of the robot that carries it. mask: (height, width), "
            "uint8, or None for no mask. The robot is where it is less than half of its largest "
            "value: 0 and 1, or 0 and 255.")
        .def("reset", &SharedOdometry::reset, "Starts anew with the same configuration and mask.");
}

void addInputError(py::module_& m)
{
    static py::handle type;
    type = py::exception<InputError>(m, "InputError", PyExc_ValueError).release();
    py::register_exception_translator(
        [](std::exception_ptr thrown)
        {
            try
            {
                std::rethrow_exception(std::move(thrown));
            }
            catch (const InputError& error)
            {
                PyErr_SetObject(type.ptr(), textOf(error.what()).ptr());
            }
        });
}

void addRawlogs(py::module_& m)
{
    py::class_<ConvertedFrame>(m, "Frame", "A frame of a rawlog, depth registered to colour.")
        .def_property_readonly("stamp", [](const ConvertedFrame& f) { return f.frame.stamp; })
        .def_property_readonly(
            "sensor_label", [](const ConvertedFrame& f) { return textOf(f.sensorLabel); })
        .def_property_readonly(
            "depth",
            [](const ConvertedFrame& f) { return arrayOf<float>(f.frame.depth); },
            "float32 [m], NaN for no reading; None if the frame cannot be used")
        .def_property_readonly(
            "gray",
            [](const ConvertedFrame& f) { return arrayOf<std::uint8_t>(f.frame.gray); },
            "uint8, or None")
        .def_property_readonly(
            "camera",
            [](const ConvertedFrame& f)
            { return f.problem.empty() ? std::make_optional(f.frame.camera) : std::nullopt; },
            "Camera, or None if the frame cannot be used")
        .def_property_readonly(
            "problem",
            [](const ConvertedFrame& f) { return textOf(f.problem); },
            "why it cannot be used, or empty");
    py::class_<RawlogFrames>(m, "RawlogFrames", "See read_rawlog().")
        .def("__iter__", [](RawlogFrames& self) -> RawlogFrames& { return self; })
        .def(
            "__next__",
            [](RawlogFrames& self)
            {
                auto frame = self.next();
                if (!frame)
                {
                    throw py::stop_iteration();
                }
                return *std::move(frame);
            });
    m.def(
        "read_rawlog",
        [](const std::filesystem::path& path, const std::string& label)
        { return std::make_unique<RawlogFrames>(path.string(), label); },
        py::arg("path"),
        py::arg("sensor_label") = "",
        "The frames of one camera, by default the first one's, one after the other. Damage raises "
        "InputError after the frames before it. So does a label that no camera has, and a rawlog "
        "without a camera.");
}
}  // namespace
}  // namespace pointplane

PYBIND11_MODULE(pointplane, m)
{
    using namespace pointplane;
    m.doc() = "RGB-D visual odometry from noisy points and planes, with covariances.";
    m.attr("__version__") = POINTPLANE_VERSION;
    // NumPy is loaded here. pybind11 would load it for the first array, where two threads that need
    // one wait for each other.
    (void)py::dtype::of<float>();
    addInputError(m);
    addCamera(m);
    addResult(m);
    addRawlogs(m);  // before who takes its frames, whose help names them
    addOdometry(m);
}
