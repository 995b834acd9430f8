// SPDX-License-Identifier: BSD-3-Clause
#include "nees_output.h"

#include <pointplane/core/counted.h>
#include <pointplane/core/number_text.h>
#include <pointplane/evaluation/scored_trajectories.h>
#include <pointplane/evaluation/units.h>

#include <array>
#include <cmath>
#include <ostream>

namespace pointplane
{
namespace
{
constexpr std::array<const char*, 6> kAxes{"x", "y", "z", "rx", "ry", "rz"};

/** Shown in mm or deg. */
double shown(double value, std::size_t axis)
{
    return value * (axis < 3 ? 1000 : kDegreesPerRadian);
}

std::string testColumns(const ConsistencyTest& test)
{
    return " " + numberText(test.nees, 3, 9) +
           format("   [%.3f, %.3f]  %s\n", test.lower, test.upper, shortVerdict(test).c_str());
}

/** The most optimistic direction in its larger components. */
std::string direction(const Vector6d& v)
{
    std::string out;
    for (std::size_t k = 0; k < kAxes.size(); ++k)
    {
        const double component = v[static_cast<Eigen::Index>(k)];
        if (std::abs(component) > 0.3)
        {
            out += format("%s%+.2f %s", out.empty() ? "" : ", ", component, kAxes[k]);
        }
    }
    return out;
}

/** Those of which the root mean squares alone would not tell that sigma is too small at times. */
std::string axesThatSeemConsistent(const NeesResult& r)
{
    std::string out;
    for (std::size_t k = 0; k < kAxes.size(); ++k)
    {
        const AxisConsistency& a = r.axes[k];
        const bool seems = a.test.nees > 1 && a.rmsError < a.rmsSigma;
        out += seems ? (out.empty() ? "" : ", ") + std::string(kAxes[k]) : "";
    }
    return out;
}

nlohmann::ordered_json testJson(const ConsistencyTest& test)
{
    return {
        {"neesPerDof", test.nees},
        {"lower95", test.lower},
        {"upper95", test.upper},
        {"verdict", shortVerdict(test)}};
}

void printInterval(const NeesResult& r, std::ostream& out)
{
    out << format(
        "\n%s: %zu, %zu without overlap\n%-14s%12s%12s%12s%10s   %s\n",
        (r.interval.sinceStart ? "poses since the first one"
                               : "increments of " + nameOf(r.interval))
            .c_str(),
        r.increments,
        r.independent,
        "",
        "mean error",
        "rms error",
        "rms sigma",
        "NEES/dof",
        "95 % bounds");
    for (std::size_t k = 0; k < kAxes.size(); ++k)
    {
        const AxisConsistency& a = r.axes[k];
        out << format("%-14s", (std::string(kAxes[k]) + (k < 3 ? " [mm]" : " [deg]")).c_str());
        for (const double value : {a.meanError, a.rmsError, a.rmsSigma})
        {
            out << numberText(shown(value, k), 4, 12);
        }
        out << testColumns(a.test);
    }
    out << format("%-50s", "translation") << testColumns(r.translation)  //
        << format("%-50s", "rotation") << testColumns(r.rotation)        //
        << format("%-50s", "joint") << testColumns(r.joint) << "anisotropy: from "
        << numberText(r.whitenedEigenvalues[0], 3) << " to "
        << numberText(r.whitenedEigenvalues[5], 3) << " along the worst direction ("
        << direction(r.mostOptimistic) << ", whitened)\n"
        << "verdict: " << verdict(r.joint) << "\n";
    if (const std::string axes = axesThatSeemConsistent(r); r.joint.isOptimistic() && !axes.empty())
    {
        out << axes << ": rms error is below rms sigma, but errors are large where sigma is small; "
            << "--report has both over time\n";
    }
}
}  // namespace

std::string savedIncrements(const std::string& file, const Trajectory& estimate, const NeesRun& run)
{
    std::string out;
    for (const NeesRun::Tested& tested : run.tested)
    {
        for (const NeesIncrement& increment : tested.increments)
        {
            out += csvField(file) + "," + nameOf(tested.interval) + "," +
                   savedStamp(estimate.stamps[increment.i]) + "," +
                   savedStamp(estimate.stamps[increment.j]);
            for (Eigen::Index k = 0; k < 6; ++k)
            {
                out += format(",%.6g", increment.error[k]);
            }
            for (Eigen::Index k = 0; k < 6; ++k)
            {
                out += format(",%.6g", std::sqrt(increment.cov(k, k)));
            }
            out += format(",%.6g\n", increment.nees);
        }
    }
    return out;
}

std::string describeTruthNoise(const NeesOptions& options)
{
    const Eigen::Vector3d deg = options.truthSigmaRotation * kDegreesPerRadian;
    const std::string translation = format("sigma %g m and ", options.truthSigmaTranslation);
    return translation +
           (deg == Eigen::Vector3d::Constant(deg.x())
                ? format("%g deg per axis and pose", deg.x())
                : format("%g, %g, %g deg about x, y, z per pose", deg.x(), deg.y(), deg.z()));
}

std::string describe(const NeesReport& report)
{
    return format(
        "normalised estimation error squared of increments, %s, ground truth %s with "
        "%s%s",
        counted(report.files.size() / 2, "run").c_str(),
        report.options.truthAt == TruthAt::Interpolated ? "interpolated" : "at the nearest stamp",
        describeTruthNoise(report.options).c_str(),
        describeChanges(report.options.offset, 1).c_str());
}

void printTable(const NeesReport& report, std::ostream& out)
{
    out << "Covariance consistency: " << describe(report) << "\n";
    for (std::size_t k = 0; k + 1 < report.files.size(); k += 2)
    {
        out << "ground truth " << inOneLine(report.files[k]) << ", estimate "
            << inOneLine(report.files[k + 1]) << "\n"
            << describe(report.coverages[k / 2]) << "\n";
    }
    for (const NeesResult& result : report.results)
    {
        printInterval(result, out);
    }
}

nlohmann::ordered_json toJson(const NeesReport& report)
{
    nlohmann::ordered_json json;
    json["title"] = "Covariance consistency";
    json["protocol"] = describe(report);
    json["files"] = report.files;
    for (const Coverage& coverage : report.coverages)
    {
        json["coverage"].push_back(toJson(coverage));
    }
    json["truthSigmaTranslation"] = report.options.truthSigmaTranslation;
    const Eigen::Vector3d& sigma = report.options.truthSigmaRotation;
    json["truthSigmaRotation"] = {sigma.x(), sigma.y(), sigma.z()};
    json["intervals"] = nlohmann::ordered_json::array();
    for (const NeesResult& r : report.results)
    {
        nlohmann::ordered_json item;
        item["interval"] = nameOf(r.interval);
        item["increments"] = r.increments;
        item["independent"] = r.independent;
        item["joint"] = testJson(r.joint);
        item["translation"] = testJson(r.translation);
        item["rotation"] = testJson(r.rotation);
        for (std::size_t k = 0; k < kAxes.size(); ++k)
        {
            nlohmann::ordered_json axis = testJson(r.axes[k].test);
            axis["meanError"] = r.axes[k].meanError;
            axis["rmsError"] = r.axes[k].rmsError;
            axis["rmsSigma"] = r.axes[k].rmsSigma;
            item["axes"][kAxes[k]] = axis;
        }
        item["whitenedEigenvalues"] =
            std::vector<double>(r.whitenedEigenvalues.data(), r.whitenedEigenvalues.data() + 6);
        item["verdict"] = verdict(r.joint);
        json["intervals"].push_back(item);
    }
    return json;
}

std::string toCsv(const NeesReport& report)
{
    std::string out =
        "interval,increments,independent,quantity,nees_per_dof,lower95,upper95,mean_error,"
        "rms_error,rms_sigma\n";
    for (const NeesResult& r : report.results)
    {
        const auto row = [&](const std::string& quantity, const ConsistencyTest& test)
        {
            return nameOf(r.interval) +
                   format(",%zu,%zu,%s", r.increments, r.independent, quantity.c_str()) +
                   format(",%.9g,%.9g,%.9g,", test.nees, test.lower, test.upper);
        };
        out += row("joint", r.joint) + ",,\n" + row("translation", r.translation) + ",,\n" +
               row("rotation", r.rotation) + ",,\n";
        for (std::size_t k = 0; k < kAxes.size(); ++k)
        {
            const AxisConsistency& a = r.axes[k];
            out += row(kAxes[k], a.test) +
                   format("%.9g,%.9g,%.9g\n", a.meanError, a.rmsError, a.rmsSigma);
        }
    }
    return out;
}

void writeReport(const NeesReport& report, const OutputFiles& files, std::ostream& out)
{
    if (!files.replaceTable())
    {
        printTable(report, out);
    }
    const std::string header =
        "estimate,interval,stamp_i,stamp_j,error_x_m,error_y_m,error_z_m,error_rx_rad,error_ry_rad,"
        "error_rz_rad,sigma_x_m,sigma_y_m,sigma_z_m,sigma_rx_rad,sigma_ry_rad,sigma_rz_rad,nees\n";
    files.write(toJson(report), toCsv(report), header + report.saved, out);
}
}  // namespace pointplane
