// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BagRecording.h"
#include "FolderFrames.h"
#include "KlgRecording.h"
#include "TumRecording.h"
#include "convert_recording.h"
#include <CLI/CLI.hpp>

namespace pointplane
{
/** What the command line says; of the inputs, only that of its command. */
struct ConvertOptions
{
    TumOptions tum;
    FolderOptions folder;
    KlgOptions klg;
    BagOptions bag;
    RecordingOutput output;
};

/** The commands tum, folder, klg and bag. */
void addConvertCommands(CLI::App& app, ConvertOptions& options);
}  // namespace pointplane
