// SPDX-License-Identifier: BSD-3-Clause
#include "OutputGuard.h"

#include <pointplane/mrpt_io/OutputFile.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/rawlog_names.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "standard_streams.h"
#include <sys/stat.h>
#include <unistd.h>

namespace pointplane
{
namespace
{
namespace fs = std::filesystem;

[[nodiscard]] fs::path folderOf(const fs::path& path)
{
    return path.parent_path().empty() ? "." : path.parent_path();
}

/** The nearest folder on the way to `path` that is there. */
[[nodiscard]] fs::path existingFolder(fs::path path)
{
    std::error_code error;
    while (!fs::exists(path, error) && path.has_relative_path())
    {
        path = folderOf(path);
        if (path == ".")
        {
            break;
        }
    }
    return path;
}

/** Where a name is too long for the disk, before the run finds out. */
void requireShortName(const std::string& option, const std::string& path, const fs::path& written)
{
    const long most = ::pathconf(existingFolder(folderOf(written)).c_str(), _PC_NAME_MAX);
    const std::string name = written.filename().string();
    if (most > 0 && name.size() > static_cast<std::size_t>(most))
    {
        throw InputError(
            option + " " + path + ": needs a name of " + std::to_string(name.size()) +
            " bytes while it is written, but " + std::to_string(most) +
            " are the most; give a shorter one");
    }
}

/** Whether nothing is lost if `text` replaces this file, or what it leads to. */
[[nodiscard]] bool isReplaceable(const std::string& path, const std::string& text)
{
    std::error_code error;
    if (!fs::is_regular_file(path, error))
    {
        return true;
    }
    std::ifstream file(path, std::ios::binary);
    std::string start(text.size() + 1, '\0');
    file.read(start.data(), static_cast<std::streamsize>(start.size()));
    start.resize(static_cast<std::size_t>(file.gcount()));
    const bool isOwn = !fs::is_symlink(path, error) &&
                       (start.rfind(kRenderedTruth, 0) == 0 || start.rfind(kCopiedTruth, 0) == 0);
    return file.is_open() && (isOwn || text.find(start) != std::string::npos);
}

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

[[noreturn]] void failToWrite(const std::string& option, const std::string& path)
{
    throw EnvironmentError(option + ": cannot write " + path + ": " + std::strerror(errno));
}
}  // namespace

OutputGuard::File OutputGuard::fileAt(const std::string& path)
{
    File file;
    std::error_code error;
    const fs::path real = fs::weakly_canonical(outputTarget(path).path, error);
    file.path = error ? fs::absolute(path, error).string() : real.string();
    if (file.path.size() > 1 && file.path.back() == '/')
    {
        file.path.pop_back();
    }
    struct stat info = {};
    if (::stat(path.c_str(), &info) == 0)
    {
        file.device = info.st_dev;
        file.inode = info.st_ino;
    }
    return file;
}

OutputGuard::File OutputGuard::inputFolderAt(const std::string& path)
{
    File folder = fileAt(path);
    folder.holdsInputs = true;
    return folder;
}

bool OutputGuard::same(const File& a, const File& b)
{
    return a.path == b.path || (a.inode != 0 && a.inode == b.inode && a.device == b.device);
}

bool OutputGuard::isIn(const File& file, const File& folder)
{
    return file.path.size() > folder.path.size() && file.path[folder.path.size()] == '/' &&
           file.path.compare(0, folder.path.size(), folder.path) == 0;
}

bool OutputGuard::writes(const Output& output, const File& file)
{
    if (output.isFolder)
    {
        const fs::path path(file.path);
        return (output.extension.empty() || path.extension() == output.extension) &&
               std::any_of(
                   output.files.begin(),
                   output.files.end(),
                   [&](const File& folder) { return path.parent_path() == folder.path; });
    }
    for (const File& written : output.files)
    {
        if (same(written, file))
        {
            return true;
        }
    }
    return false;
}

void OutputGuard::keepApart(const Output& output, const File& input)
{
    const File& first = output.files.front();
    if (same(first, input))
    {
        throw InputError(output.option + " " + output.name + ": is an input; give another name");
    }
    if (writes(output, input))
    {
        throw InputError(
            output.option + " " + output.name + ": would write over the input " + input.path +
            "; give another name");
    }
    if (input.holdsInputs && isIn(first, input))
    {
        throw InputError(
            output.option + " " + output.name + ": is in the folder of the inputs, " + input.path +
            "; give another one");
    }
}

void OutputGuard::check(const File& input) const
{
    for (const Output& output : outputs_)
    {
        keepApart(output, input);
    }
}

void OutputGuard::checkInput(const std::string& path) const
{
    if (!outputs_.empty() && !path.empty())
    {
        check(fileAt(path));
    }
}

void OutputGuard::checkInputFolder(const std::string& path) const
{
    if (!outputs_.empty() && !path.empty())
    {
        check(inputFolderAt(path));
    }
}

void OutputGuard::addInput(const std::string& path)
{
    checkInput(path);
    if (!path.empty())
    {
        inputs_.push_back(fileAt(path));
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

void OutputGuard::addInputFolder(const std::string& path)
{
    checkInputFolder(path);
    if (!path.empty())
    {
        inputs_.push_back(inputFolderAt(path));
    }
}

void OutputGuard::add(const Output& output)
{
    for (const File& input : inputs_)
    {
        keepApart(output, input);
    }
    for (const Output& other : outputs_)
    {
        for (const File& file : output.files)
        {
            const File& first = other.files.front();
            const bool isFileAndFolder =
                output.isFolder != other.isFolder && same(output.files.front(), first);
            if (isFileAndFolder || writes(other, file) ||
                (output.isFolder && writes(output, first)))
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
    if (path == "-")
    {
        throw InputError(
            option + " -: give /dev/stdout for the standard output, ./- for a file of this name");
    }
    std::error_code error;
    const auto status = fs::status(path, error);
    if (fs::is_directory(status) || path.back() == '/')
    {
        throw InputError(option + " " + path + ": is a folder; give the name of a file");
    }
    if (fs::is_block_file(status))
    {
        throw InputError(option + " " + path + ": is a disk; give the name of a file");
    }
    if (isStandardOutput(path))
    {
        requireStandardOutput();
    }
    const OutputTarget target = outputTarget(path);
    requireShortName(option, path, target.writtenPath());
    // The file and, where it is made anew, its folder.
    if ((fs::exists(status) && ::access(path.c_str(), W_OK) != 0) ||
        (target.isReplaced && ::access(folderOf(target.path).c_str(), W_OK | X_OK) != 0))
    {
        failToWrite(option, path);
    }
    if (fs::is_character_file(status))
    {
        return;  // /dev/null takes any number of outputs
    }
    Output output{option, path, {fileAt(path)}, false, ""};
    if (target.isReplaced)
    {
        output.files.push_back(fileAt(target.writtenPath()));
    }
    add(output);
}

void OutputGuard::addRawlog(const std::string& option, const std::string& path)
{
    addOutput(option, path);
    fs::path name = fs::path(path).filename();
    const bool isCompressed = name.extension() == ".gz";
    name = isCompressed ? name.stem() : name;
    const bool isNamedSo = name.extension() == ".rawlog" ||
                           (!isCompressed && name.string().find('.') == std::string::npos);
    if (!path.empty() && !isNamedSo && hasPlaceBeside(path))
    {
        throw InputError(
            option + " " + path +
            ": would be a rawlog; give a name that ends in .rawlog or .rawlog.gz");
    }
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
        add(folderAt(option, path, extension));
    }
}

OutputGuard::Output OutputGuard::folderAt(
    const std::string& option, const std::string& path, const std::string& extension)
{
    const fs::path folder = existingFolder(path);
    std::error_code error;
    if (!fs::is_directory(folder, error))
    {
        throw InputError(option + " " + path + ": " + folder.string() + " is not a folder");
    }
    if (::access(folder.c_str(), W_OK | X_OK) != 0)
    {
        failToWrite(option, path);
    }
    return {option, path, {fileAt(path)}, true, extension};
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
            ": is not a file that a folder can be beside; give the name of "
            "a file");
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
    Output output = folderAt(option, folder, "");
    output.files.push_back(fileAt(partialFolderOf(folder)));
    add(output);
}
}  // namespace pointplane
