// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/simulation/SceneBuilder.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "scenes_internal.h"
#include "two_pi.h"

namespace pointplane
{
namespace
{
using Finish = SceneBuilder::Finish;

/** Turned by yaw about the vertical, then moved to the place. */
Eigen::Isometry3d placed(const Eigen::Vector3d& at, double yaw)
{
    Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
    out.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    out.translation() = at;
    return out;
}

/** Turned about an axis through a point. */
Eigen::Isometry3d turnedAbout(
    const Eigen::Vector3d& point, const Eigen::Vector3d& axis, double angle)
{
    Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
    out.linear() = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
    out.translation() = point - out.linear() * point;
    return out;
}

/** 0 until `start`, then to 1 and back every `period`, starting and turning softly. */
double toAndFro(double t, double start, double period)
{
    return t < start ? 0 : 0.5 - 0.5 * std::cos(kTwoPi * (t - start) / period);
}

Painter pattern(Random& random, int count)
{
    return [&random, count](Canvas& canvas)
    {
        canvas.shapes(0, 0, canvas.width(), canvas.height(), count, random);
        canvas.addNoise(0.02, 4, 3, random);
    };
}

/** The furnished room with a ceiling: these cameras look about. */
SceneBuilder closedRoom(const std::string& name, std::uint64_t seed)
{
    SceneBuilder builder = furnishedRoom(name, seed);
    builder.addRectangle({-2.5, 2.4, 2.6}, {5.1, 0, 0}, {0, -4.8, 0}, {{215, 215, 215}, 4e-3, {}});
    return builder;
}

/** Walks to and fro across the room, out of view at the beginning. */
Eigen::Isometry3d walk(double t)
{
    const double period = 6.5, reach = 1.45, bow = 0.3, phase = kTwoPi * t / period;
    const Eigen::Vector3d at(-0.35 + bow * std::sin(2 * phase), reach * std::cos(phase), 0);
    const double vx = 2 * bow * std::cos(2 * phase), vy = -reach * std::sin(phase);
    return placed(at, std::atan2(vy, vx));
}

/** A person of 1.72 m whose limbs swing, at rest in the origin, facing x. */
void addPerson(SceneBuilder& builder, Random& random)
{
    const double hip = 0.85, shoulder = 1.42;  // [m]
    constexpr double kStrides = 0.9;           // [Hz]
    const Finish shirt{{60, 70, 170}, 1.5e-3, pattern(random, 30)};
    const Finish trousers{{110, 70, 50}, 1.5e-3, pattern(random, 8)};
    const Finish skin{{140, 170, 215}, 1.5e-3, pattern(random, 3)};
    builder.beginMover("person", walk);
    builder.addBox({0, 0, hip}, {0.22, 0.4, 0.6}, 0, shirt, shirt);
    builder.addCylinder({0, 0, hip + 0.6}, 0.05, 0.06, skin, skin);
    builder.addCylinder({0, 0, hip + 0.65}, 0.09, 0.22, skin, {{40, 50, 60}, 2e-3, {}});
    const auto limb = [&](const std::string& name, double y, double top, double swing)
    {
        builder.beginMover(
            name,
            [y, top, swing](double t) -> Eigen::Isometry3d
            {
                return walk(t) * turnedAbout(
                                     {0, y, top},
                                     Eigen::Vector3d::UnitY(),
                                     swing * std::sin(kTwoPi * kStrides * t));
            });
    };
    limb("left leg", 0.1, hip, 0.4);
    builder.addCylinder({0, 0.1, 0}, 0.075, hip, trousers, trousers);
    limb("right leg", -0.1, hip, -0.4);
    builder.addCylinder({0, -0.1, 0}, 0.075, hip, trousers, trousers);
    limb("left arm", 0.25, shoulder, -0.3);
    builder.addCylinder({0, 0.25, hip}, 0.045, shoulder - hip, shirt, shirt);
    limb("right arm", -0.25, shoulder, 0.3);
    builder.addCylinder({0, -0.25, hip}, 0.045, shoulder - hip, shirt, shirt);
    builder.endMover();
}

/** Goes from one place between -1 and 1 to the next within a second, and rests there: two seconds
 * in all. */
std::function<double(double t)> restless(Random& random)
{
    constexpr int kPlaces = 64;  // then again from the beginning
    constexpr double kStay = 2;  // [s]
    std::vector<double> places, ways;
    for (int i = 0; i < kPlaces; ++i)
    {
        places.push_back(random.uniform(-1, 1));
        ways.push_back(random.uniform(0.4, 1));
    }
    const double phase = random.uniform(0, kStay);
    return [places, ways, phase](double t)
    {
        const double time = std::max(0.0, t + phase) / kStay;
        const auto stay = static_cast<size_t>(time);
        const size_t from = stay % kPlaces, to = (stay + 1) % kPlaces;
        const double way = std::min(1.0, (time - std::floor(time)) * kStay / ways[from]);
        return places[from] + (places[to] - places[from]) * 0.5 * (1 - std::cos(M_PI * way));
    };
}

/** A person who sits, talks and gestures with upper body, head and both arms; the legs stay where
 * they are. \param at on the floor [m] \param yaw of where the person faces [rad] */
void addSeated(SceneBuilder& builder, Random& random, const Eigen::Vector3d& at, double yaw)
{
    const Eigen::Isometry3d seat = placed(at, yaw);
    const double hip = 0.5, shoulder = 1.05;  // [m]
    const Finish shirt{randomColour(random, 60, 180), 1.5e-3, pattern(random, 35)};
    const Finish trousers{{110, 70, 50}, 1.5e-3, pattern(random, 8)};
    const Finish skin{{140, 170, 215}, 1.5e-3, pattern(random, 5)};
    const auto lean = restless(random), bend = restless(random);
    const auto upper = [seat, lean, bend, hip](double t)
    {
        return seat * turnedAbout({0, 0, hip}, Eigen::Vector3d::UnitY(), 0.08 * lean(t)) *
               turnedAbout({0, 0, hip}, Eigen::Vector3d::UnitX(), 0.1 * bend(t));
    };
    builder.addBox(seat * Eigen::Vector3d(0.2, 0, 0), {0.5, 0.4, hip}, yaw, trousers, trousers);
    builder.beginMover("trunk", upper);
    builder.addBox({0, 0, hip}, {0.22, 0.42, shoulder + 0.05 - hip}, 0, shirt, shirt);
    const auto turn = restless(random);
    builder.beginMover(
        "head",
        [upper, turn](double t) {
            return upper(t) * turnedAbout({0, 0, 0}, Eigen::Vector3d::UnitZ(), 0.5 * turn(t));
        });
    builder.addCylinder({0, 0, shoulder + 0.05}, 0.05, 0.06, skin, skin);
    builder.addCylinder({0, 0, shoulder + 0.11}, 0.09, 0.22, skin, {{40, 50, 60}, 2e-3, {}});
    for (const double side : {-1.0, 1.0})
    {
        const auto lift = restless(random);
        const Eigen::Vector3d joint(0, 0.25 * side, shoulder);
        builder.beginMover(
            side < 0 ? "right arm" : "left arm",
            [upper, lift, joint](double t) {
                return upper(t) *
                       turnedAbout(joint, Eigen::Vector3d::UnitY(), -0.9 - 0.5 * lift(t));
            });
        builder.addCylinder(joint - Eigen::Vector3d(0, 0, 0.55), 0.05, 0.55, shirt, skin);
    }
    builder.endMover();
}

/** A camera held in a hand in one place. \param eye, target [m] \param rate of the hand [m/s] and
 * [rad/s] */
void watch(
    CameraMotion& motion, const Eigen::Vector3d& eye, const Eigen::Vector3d& target, double rate)
{
    motion.eye = eye;
    motion.target = target;
    motion.handSpeed = rate;
    motion.handTurnRate = rate;
}
}  // namespace

Scene makePerson(std::uint64_t seed)
{
    SceneBuilder builder = closedRoom("person", seed);
    Random random({seed, 4});
    addPerson(builder, random);
    watch(builder.scene().motion, {-2.0, 0.0, 1.35}, {0.8, 0.0, 0.95}, 0.2);
    return builder.build(roomLamp());
}

Scene makePush(std::uint64_t seed)
{
    SceneBuilder builder = furnishedRoom("push", seed);
    Random random({seed, 5});
    builder.beginMover(
        "box",
        [](double t) -> Eigen::Isometry3d
        {
            const double way = toAndFro(t, 0.5, 4);
            return placed({0, 0.75 * way, 0}, 0) *
                   turnedAbout({0.2, -0.5, 0}, Eigen::Vector3d::UnitZ(), 0.4 * way);
        });
    const Finish card{{90, 140, 180}, 1e-3, pattern(random, 25)};
    builder.addBox({0.2, -0.5, 0.75}, {0.16, 0.26, 0.22}, 0.1, card, card);
    builder.endMover();
    watch(builder.scene().motion, {-0.45, 0.0, 1.35}, {0.8, 0.0, 0.75}, 0.2);
    return builder.build(roomLamp());
}

Scene makeDoor(std::uint64_t seed)
{
    SceneBuilder builder = closedRoom("door", seed);
    Random random({seed, 6});
    // A cupboard's door before the wall behind the desk's room, hinged on its left.
    const Eigen::Vector3d hinge(-2.4, -0.5, 0), width(0, 1.0, 0);
    const auto wood = [&random](Canvas& canvas)
    {
        canvas.addNoise(0.3, 6, 4, random);
        canvas.fillRectangle(0.12, 0.15, canvas.width() - 0.24, 0.75, {120, 150, 175});
        canvas.fillRectangle(0.12, 1.1, canvas.width() - 0.24, 0.8, {120, 150, 175});
        canvas.poster(0.3, 0.25, 0.35, 0.5, random);
        canvas.fillCircle(0.08, 1.05, 0.025, {60, 60, 60});
    };
    builder.beginMover(
        "door",
        [hinge](double t)
        { return turnedAbout(hinge, Eigen::Vector3d::UnitZ(), -1.3 * toAndFro(t, 0.5, 5)); });
    const double height = 2.05, thick = 0.03;
    const Finish leaf{{110, 140, 165}, 2e-3, wood};
    builder.addWall(hinge, hinge + width, height, leaf);
    const Eigen::Vector3d behind = hinge - Eigen::Vector3d(thick, 0, 0);
    builder.addWall(behind + width, behind, height, leaf);
    builder.addWall(hinge + width, behind + width, height, {{90, 120, 140}, 2e-3, {}});
    builder.endMover();
    watch(builder.scene().motion, {0.0, 0.3, 1.4}, {-2.4, 0.1, 1.15}, 0.2);
    return builder.build(roomLamp());
}

Scene makeHalf(std::uint64_t seed)
{
    SceneBuilder builder = closedRoom("half", seed);
    Random random({seed, 7});
    const auto print = [&random](Canvas& canvas)
    {
        canvas.poster(0.05, 0.1, 0.6, 0.85, random);
        canvas.poster(0.7, 0.1, 0.6, 0.85, random);
        canvas.shapes(0.05, 1.0, canvas.width() - 0.1, 0.85, 60, random);
        canvas.addNoise(0.03, 4, 3, random);
    };
    builder.beginMover(
        "screen",
        [](double t)
        {
            const double way = toAndFro(t, 0.5, 3);
            return placed({0.12 * way, -0.35 * way, 0}, 0);
        });
    builder.addWall({-0.6, 1.5, 0.05}, {-0.6, 0.12, 0.05}, 1.95, {{150, 120, 90}, 1.5e-3, print});
    builder.endMover();
    watch(builder.scene().motion, {-1.8, 0.0, 1.3}, {0.8, 0.0, 1.0}, 0.15);
    return builder.build(roomLamp());
}

Scene makeSeated(std::uint64_t seed)
{
    SceneBuilder builder = closedRoom("seated", seed);
    Random random({seed, 8});
    addSeated(builder, random, {-0.1, 0.33, 0}, 3.0);
    addSeated(builder, random, {-0.2, -0.4, 0}, 3.4);
    watch(builder.scene().motion, {-1.45, 0.0, 1.2}, {0.8, 0.0, 0.85}, 0.015);
    return builder.build(roomLamp());
}
}  // namespace pointplane
