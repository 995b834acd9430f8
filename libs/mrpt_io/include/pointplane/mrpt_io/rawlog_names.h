// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace pointplane
{
/** Folder for the external images of a rawlog, by MRPT's rule: the path without its last extension,
 * and "_Images". */
[[nodiscard]] std::string imagesFolderOf(const std::string& rawlog);

/** The folder that a rawlog's external images and ranges are in, by MRPT's rule: NAME_Images or a
 * variant of it, else Images, beside the rawlog, or beside the file that a link leads to;
 * imagesFolderOf() where none of them is there. Of a partial rawlog, the partial folder first. */
[[nodiscard]] std::string imagesFolderToRead(const std::string& rawlog);

/** Where such a folder is until its rawlog is complete. */
[[nodiscard]] std::string partialFolderOf(const std::string& imagesFolder);

/** Ground truth of a rawlog, as TUM text: NAME.groundtruth.txt beside NAME.rawlog (or
 * NAME.rawlog.gz). */
[[nodiscard]] std::string groundTruthOf(const std::string& rawlog);

/** Whether files that belong to a rawlog can be written beside it: no, where its name is that of a
 * device, of a pipe, or of the file that the standard output goes to. */
[[nodiscard]] bool hasPlaceBeside(const std::string& rawlog);
}  // namespace pointplane
