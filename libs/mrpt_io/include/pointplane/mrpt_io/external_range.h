// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/math/CMatrixDynamic.h>
#include <mrpt/obs/CObservation3DRangeScan.h>

#include <string>

namespace pointplane
{
/** MRPT's external range file: gz or plain; uint32 rows, uint32 columns, uint16 readings. Its sizes
 * are checked against its contents; MRPT's own loader leaves stale rows or crashes. \throws
 * InputError naming the file */
[[nodiscard]] mrpt::math::CMatrix_u16 readExternalRange(const std::string& path);

/** Moves the range image to a file, as MRPT's rawlog-edit --externalize, and reads it back, because
 * MRPT does not check that it is there. The observation's own copy is removed, because MRPT would
 * write it into the rawlog as well.
 * \param name of the file in the directory, which is the rawlog's
 * RawlogReader::externalsDirectory() \throws EnvironmentError naming the file */
void moveRangeToFile(
    mrpt::obs::CObservation3DRangeScan& scan,
    const std::string& directory,
    const std::string& name);

/** Makes the names of external files absolute, so that the observation can move to a rawlog in
 * another folder. \param directory where relative names are \return whether any was changed */
bool makeExternalsAbsolute(mrpt::obs::CObservation3DRangeScan& scan, const std::string& directory);
}  // namespace pointplane
