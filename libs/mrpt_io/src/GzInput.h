// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <zlib.h>

namespace pointplane
{
/** Bytes of a file that is plain or one or more gz streams (members), telling apart its complete
 * end, an early one and corruption. */
class GzInput
{
 public:
    enum class End
    {
        Open,
        Clean,
        Truncated,
        Damaged
    };

    /** \throws InputError if the file is missing, a directory, empty or unreadable */
    explicit GzInput(const std::string& path);
    ~GzInput();
    GzInput(const GzInput&) = delete;
    GzInput& operator=(const GzInput&) = delete;

    /** Up to `size` bytes; fewer only at the end. */
    std::size_t read(void* bytes, std::size_t size);

    /** Known once read() has returned less than it was asked for. */
    [[nodiscard]] End end() const { return end_; }
    [[nodiscard]] const std::string& problem() const { return problem_; }  //!< if not clean
    [[nodiscard]] std::uint64_t fileOffset() const;                        //!< consumed so far
    [[nodiscard]] std::uint64_t fileSize() const { return fileSize_; }
    [[nodiscard]] bool isCompressed() const { return compressed_; }

    /** Keeps the compressed bytes of the member that begins here, if one does. */
    void beginMember();
    /** \return the compressed data of that member, its checksum and length (after which GzOutput
     * can put them), if it ends here; else empty */
    [[nodiscard]] std::vector<std::uint8_t> endMember();

 private:
    struct FileCloser
    {
        void operator()(std::FILE* f) const { std::fclose(f); }
    };

    bool refill();
    void finish(End end, const std::string& problem = {});
    void inflateInto(std::uint8_t* bytes, std::size_t size);
    void startNextMember();
    void expectHeader();
    int inflateSome();
    [[nodiscard]] bool isLastMember() const;
    [[nodiscard]] std::size_t headerSize() const;

    std::unique_ptr<std::FILE, FileCloser> file_;
    std::uint64_t fileSize_{0};
    std::uint64_t fileRead_{0};
    std::vector<std::uint8_t> buffer_;
    z_stream zlib_{};
    bool compressed_{false};
    bool atMemberStart_{false};
    gz_header header_{};        //!< of the member at hand
    std::uint8_t extra_[64]{};  //!< extra field of that header
    bool keeping_{false};
    bool keptAll_{false};             //!< the member that is kept has ended
    std::vector<std::uint8_t> kept_;  //!< of the member at hand, header included
    End end_{End::Open};
    std::string problem_;
};

/** What the checksums of a file say about it. */
enum class Checksums
{
    None,  //!< there are none, or the file stops before them
    Right,
    Wrong
};

/** Reads the whole file, unless it is not compressed. */
[[nodiscard]] Checksums checksumsOf(const std::string& path);
}  // namespace pointplane
