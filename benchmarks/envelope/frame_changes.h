// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/sensor/RgbdFrame.h>

namespace pointplane
{
// What a camera may fail to deliver. The images of the given frame are never modified.

/** No pixel has a depth. */
[[nodiscard]] RgbdFrame withoutDepth(const RgbdFrame& frame);

/** The colour image is black. */
[[nodiscard]] RgbdFrame withoutColour(const RgbdFrame& frame);

/** Both images are empty. */
[[nodiscard]] RgbdFrame withoutImages(const RgbdFrame& frame);

/** What the camera would see in a mirror: an image of another place, as when recordings mix. */
[[nodiscard]] RgbdFrame mirrored(const RgbdFrame& frame);

/** No depth beyond a range. \param range [m] along the optical axis */
[[nodiscard]] RgbdFrame withDepthUpTo(const RgbdFrame& frame, float range);

/** Single pixels without depth, as active cameras have on dark or shiny surfaces: others in each
 * frame. \param share of all pixels */
[[nodiscard]] RgbdFrame withHoles(const RgbdFrame& frame, double share);

/** More noise of depth, independent between pixels. \param at1m its standard deviation at 1 m [m];
 * it grows with the square of the depth */
[[nodiscard]] RgbdFrame withNoisyDepth(const RgbdFrame& frame, double at1m);

/** A dim room: less light, so less contrast and more noise. \param light share of the light
 * \param noise standard deviation, independent between pixels [grey values] */
[[nodiscard]] RgbdFrame dimmed(const RgbdFrame& frame, double light, double noise);

/** Four lines of text across the colour image, as cameras write date and time into it. */
[[nodiscard]] RgbdFrame withText(const RgbdFrame& frame);

/** 1500 bright spots in the colour image, the same in each frame: what a projector beside the
 * camera throws on a wall, seen by an infrared camera. */
[[nodiscard]] RgbdFrame withSpots(const RgbdFrame& frame);

/** The same view in fewer pixels: brightness is averaged, depth too, but not across edges.
 * \param factor divides both sides; a remainder of columns and rows is left out */
[[nodiscard]] RgbdFrame shrunk(const RgbdFrame& frame, int factor);

/** False when one of the images shows nothing: missing, all black or without any depth. */
[[nodiscard]] bool showsSomething(const RgbdFrame& frame);
}  // namespace pointplane
