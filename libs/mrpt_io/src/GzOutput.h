// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/mrpt_io/OutputFile.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

struct libdeflate_compressor;

namespace pointplane
{
/** gz file, complete or marked as not (OutputFile), made of members: each can be decompressed by
 * itself, and taken over into another file as it is (GzInput::endMember()).
 *
 * Every member says in its header that another one follows, but for an empty one at the end: no cut
 * looks like a complete file, not even one between two members. All members throw EnvironmentError.
 */
class GzOutput
{
 public:
    GzOutput(const std::string& path, int compressionLevel);

    /** Appends to the member at hand. */
    void write(const void* bytes, std::size_t size);
    /** Ends the member at hand: everything so far is in the file, even if the process is killed. */
    void flush();
    /** Takes over a member. \param body its compressed data and what follows them */
    void copyMember(const std::vector<std::uint8_t>& body);
    /** Ends the file and gives it its name. */
    void commit();
    void discard() noexcept { file_.discard(); }

    [[nodiscard]] const OutputFile& file() const { return file_; }

 private:
    struct Freer
    {
        void operator()(libdeflate_compressor* c) const;
    };

    OutputFile file_;
    std::unique_ptr<libdeflate_compressor, Freer> compressor_;
    std::vector<std::uint8_t> member_;  //!< not compressed yet
    std::vector<std::uint8_t> compressed_;
};
}  // namespace pointplane
