// SPDX-License-Identifier: BSD-3-Clause
#include "OutputGuard.h"

#include <pointplane/mrpt_io/OutputFile.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/rawlog_names.h>

#include <algorithm>
#include <filesystem>

#include "output_checks.h"
#include "own_ground_truth.h"

namespace pointplane
{
namespace
{
namespace fs = std::filesystem;

/** Another rawlog that is there, of this name without extensions, or empty. */
[[nodiscard]] std::string otherRawlogOf(const std::string& base, const std::string& rawlog)
{
    std::error_code error;
    for (const char* extension : {"", ".rawlog", ".rawlog.gz"})
    {
        const std::string other = base + extension;
        if (fs::is_regular_file(other, error) && !fs::equivalent(other, rawlog, error))
        {
            return other;
        }
    }
    return "";
}
}  // namespace

bool OutputGuard::writes(const Output& output, const FileIdentity& file)
{
    const fs::path path(file.path);
    const bool isFolder = output.kind == Kind::Folder;
    const bool isOfFolder =
        isFolder && (output.extension.empty() || path.extension() == output.extension);
    return std::any_of(
        output.files.begin(),
        output.files.end(),
        [&](const FileIdentity& written) {
            return isFolder ? isOfFolder && path.parent_path() == written.path
                            : written.isSame(file);
        });
}

void OutputGuard::keepApart(const Output& output, const Input& input)
{
    const std::string where = output.option + " " + output.name;
    const FileIdentity& first = output.files.front();
    if (first.isSame(input.file))
    {
        throw InputError(where + ": is an input; give another name");
    }
    if (writes(output, input.file))
    {
        throw InputError(
            where + ": would write over the input " + input.file.path + "; give another name");
    }
    if (input.kind == Kind::Folder && first.isIn(input.file))
    {
        throw InputError(
            where + ": is in the folder of the inputs, " + input.file.path + "; give another one");
    }
}

void OutputGuard::check(const Input& input) const
{
    for (const Output& output : outputs_)
    {
        keepApart(output, input);
    }
}

void OutputGuard::check(const std::string& path, Kind kind) const
{
    if (!outputs_.empty() && !path.empty())
    {
        check({FileIdentity(path), kind});
    }
}

void OutputGuard::add(const std::string& path, Kind kind)
{
    if (!path.empty())
    {
        const Input input{FileIdentity(path), kind};
        check(input);
        inputs_.push_back(input);
    }
}

void OutputGuard::addInputRawlog(const std::string& path)
{
    addInput(path);
    std::error_code error;
    if (const std::string truth = groundTruthOf(path); fs::exists(truth, error))
    {
        addInput(truth);
    }
}

void OutputGuard::add(const Output& output)
{
    for (const Input& input : inputs_)
    {
        keepApart(output, input);
    }
    for (const Output& other : outputs_)
    {
        for (const FileIdentity& file : output.files)
        {
            const FileIdentity& first = other.files.front();
            const bool isFileAndFolder =
                output.kind != other.kind && output.files.front().isSame(first);
            if (isFileAndFolder || writes(other, file) ||
                (output.kind == Kind::Folder && writes(output, first)))
            {
                throw InputError(
                    output.option + " " + output.name + ": would write over what " + other.option +
                    " " + other.name + " writes; give another name");
            }
        }
    }
    outputs_.push_back(output);
}

void OutputGuard::addOutput(const std::string& option, const std::string& path)
{
    if (path.empty())
    {
        return;
    }
    requireWritableFile(option, path);
    if (std::error_code error; fs::is_character_file(path, error))
    {
        return;  // /dev/null takes any number of outputs
    }
    Output output{option, path, {FileIdentity(path)}, Kind::File, ""};
    if (const OutputTarget target = outputTarget(path); target.isReplaced)
    {
        output.files.emplace_back(target.writtenPath());
    }
    add(output);
}

/** \param kind of the file, which is its ending, too */
void OutputGuard::addNamed(
    const std::string& option, const std::string& path, const std::string& kind)
{
    addOutput(option, path);
    fs::path name = fs::path(path).filename();
    const bool isCompressed = name.extension() == ".gz";
    name = isCompressed ? name.stem() : name;
    const bool isNamedSo = name.extension() == "." + kind ||
                           (!isCompressed && name.string().find('.') == std::string::npos);
    if (!path.empty() && !isNamedSo && hasPlaceBeside(path))
    {
        throw InputError(
            option + " " + path + ": would be a " + kind + "; give a name that ends in ." + kind +
            " or ." + kind + ".gz");
    }
}

void OutputGuard::addRawlog(const std::string& option, const std::string& path)
{
    addNamed(option, path, "rawlog");
}

void OutputGuard::addSimplemap(const std::string& option, const std::string& path)
{
    addNamed(option, path, "simplemap");
}

void OutputGuard::addText(const std::string& option, const std::string& path)
{
    addOutput(option, path);
    const fs::path extension = fs::path(path).extension();
    if ((extension == ".rawlog" || extension == ".gz") && hasPlaceBeside(path))
    {
        throw InputError(
            option + " " + path +
            ": would be plain text; give a name that ends neither in .rawlog nor in .gz");
    }
}

void OutputGuard::addOutputFolder(
    const std::string& option, const std::string& path, const std::string& extension)
{
    if (!path.empty())
    {
        requireWritableFolder(option, path);
        add({option, path, {FileIdentity(path)}, Kind::Folder, extension});
    }
}

void OutputGuard::addGroundTruth(const std::string& rawlog, const std::string& text)
{
    if (!hasPlaceBeside(rawlog))
    {
        return;
    }
    const std::string truth = groundTruthOf(rawlog);
    const std::string base = truth.substr(0, truth.size() - groundTruthOf("").size());
    const std::string other = otherRawlogOf(base, rawlog);
    std::error_code error;
    if (fs::exists(truth, error) && !other.empty())
    {
        throw InputError(
            "-o " + rawlog + ": its ground truth would replace " + truth + ", which is that of " +
            other + "; give another name");
    }
    addOutput("ground truth of -o", truth);
    if (!isReplaceable(truth, text))
    {
        throw InputError(
            "-o " + rawlog + ": its ground truth would replace " + truth +
            ", which is a different one; move that file or give another name");
    }
}

void OutputGuard::addFolderBeside(
    const std::string& option, const std::string& rawlog, const std::string& folder)
{
    if (!hasPlaceBeside(rawlog))
    {
        throw InputError(
            option + " " + rawlog +
            ": is not a file that a folder can be beside; give the name of a file");
    }
    requireShortName(option, rawlog, partialFolderOf(folder));
    const std::string base = folder.substr(0, folder.rfind('_'));
    const std::string other = otherRawlogOf(base, rawlog);
    std::error_code error;
    if (fs::exists(folder, error) && !other.empty() && fs::path(other).replace_extension() == base)
    {
        throw InputError(
            option + " " + rawlog + ": would replace " + folder + ", which is that of " + other +
            "; give another name");
    }
    requireWritableFolder(option, folder);
    const FileIdentity partial(partialFolderOf(folder));
    add({option, folder, {FileIdentity(folder), partial}, Kind::Folder, ""});
}
}  // namespace pointplane
