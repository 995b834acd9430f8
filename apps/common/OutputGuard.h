// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "FileIdentity.h"

namespace pointplane
{
/** Keeps apart what a run reads and what it writes, before anything is opened. A program tells it
 * every file, also those that it opens itself (listings, images, ground truth, configuration); in
 * any order, and further inputs while it runs. Files are told apart by FileIdentity.
 *
 * All members throw InputError, in one line that names option and file; EnvironmentError if a file
 * cannot be written. Empty paths are ignored. */
class OutputGuard
{
 public:
    /** A file. Need not be there, and may be something else: its reader reports that. */
    void addInput(const std::string& path) { add(path, Kind::File); }

    /** A rawlog, and its ground truth if that is beside it. */
    void addInputRawlog(const std::string& path);

    /** A folder and all that is in it. */
    void addInputFolder(const std::string& path) { add(path, Kind::Folder); }

    /** As addInput() and addInputFolder(), when all outputs are known: check and keep nothing.
     * Thread-safe.
     * @{ */
    void checkInput(const std::string& path) const { check(path, Kind::File); }
    void checkInputFolder(const std::string& path) const { check(path, Kind::Folder); }
    /** @} */

    /** \param option that names it, e.g. "--trajectory" */
    void addOutput(const std::string& option, const std::string& path);

    /** As addOutput(), for a rawlog. The name of a file has to end in .rawlog or .rawlog.gz if it
     * has an extension: that of something else may be a file of the user's. */
    void addRawlog(const std::string& option, const std::string& path);

    /** As addRawlog(), for a simplemap: .simplemap or .simplemap.gz. */
    void addSimplemap(const std::string& option, const std::string& path);

    /** As addOutput(), for a text. The name of a file may not end in .rawlog or .gz: that is what
     * it would not be, and such a file may be a recording of the user's. */
    void addText(const std::string& option, const std::string& path);

    /** A folder, made if need be, in which files are written.
     * \param extension of these files, e.g. ".png"; empty: any */
    void addOutputFolder(
        const std::string& option, const std::string& path, const std::string& extension);

    /** The ground truth beside a rawlog that is an output itself, if there is a place for it.
     * Nobody named that file, so what may be a user's is refused: that of another rawlog (a,
     * a.rawlog and a.rawlog.gz have one name for it), what a link leads to, and any other file that
     * neither is in the text nor is the programs' own. \param text that will be written */
    void addGroundTruth(const std::string& rawlog, const std::string& text);

    /** As addOutputFolder(), for one beside a rawlog that is an output itself, and for the partial
     * one (partialFolderOf()). Refused if it is that of another rawlog. \param folder
     * NAME_Images or NAME_Masks */
    void addFolderBeside(
        const std::string& option, const std::string& rawlog, const std::string& folder);

 private:
    enum class Kind
    {
        File,
        Folder
    };
    struct Input
    {
        FileIdentity file;
        Kind kind;
    };
    struct Output
    {
        std::string option, name;         //!< as given
        std::vector<FileIdentity> files;  //!< itself and the partial one, if there is one
        Kind kind;
        std::string extension;  //!< of what is written into the folder
    };

    [[nodiscard]] static bool writes(const Output& output, const FileIdentity& file);
    static void keepApart(const Output& output, const Input& input);
    void check(const Input& input) const;
    void check(const std::string& path, Kind kind) const;
    void add(const std::string& path, Kind kind);
    void addNamed(const std::string& option, const std::string& path, const std::string& kind);
    void add(const Output& output);

    std::vector<Output> outputs_;
    std::vector<Input> inputs_;
};
}  // namespace pointplane
