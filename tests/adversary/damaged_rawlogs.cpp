// SPDX-License-Identifier: BSD-3-Clause
#include "Attempt.h"
#include "OdometryApp.h"
#include "TempDir.h"
#include "rawlog_samples.h"

namespace pointplane::adversary
{
namespace
{
constexpr int kFrames = 6;
constexpr int kEach = 100;

enum class Damage
{
    Cut,
    FlippedBit,
    ZeroedBytes,
    ForeignBytes
};

[[nodiscard]] std::string damaged(std::string bytes, Damage damage, std::mt19937& rng)
{
    const std::size_t at = 1 + rng() % (bytes.size() - 1);
    const std::size_t size = std::min<std::size_t>(1 + rng() % 64, bytes.size() - at);
    switch (damage)
    {
        case Damage::Cut:
            return bytes.substr(0, at);
        case Damage::FlippedBit:
            bytes[at] = static_cast<char>(bytes[at] ^ (1 << (rng() % 8)));
            return bytes;
        case Damage::ZeroedBytes:
            return bytes.replace(at, size, size, '\0');
        case Damage::ForeignBytes:
            for (std::size_t i = 0; i < size; ++i)
            {
                bytes[at + i] = static_cast<char>(rng());
            }
            return bytes;
    }
    return bytes;
}

/** Without a word: all frames must be there. A file with checksums is then the same as before. */
[[nodiscard]] std::string wrongIfFine(
    const Attempt& a, const std::string& path, bool isGz, const std::string& plain)
{
    if (a.code != 0)
    {
        return "";
    }
    if (isGz)
    {
        return unless(test::decompressed(path) == plain, "damage passed");
    }
    const bool told = a.out.find(" 6 frames") != std::string::npos ||
                      a.out.find("not used:") != std::string::npos;
    return unless(told, "frames are missing without a word: " + a.out);
}
}  // namespace

Tally damagedRawlogs(double share)
{
    Tally tally("damaged rawlogs, plain and gz: cut, bits flipped, bytes zeroed or foreign");
    const test::TempDir dir;
    std::mt19937 rng(21);
    for (const bool format1 : {false, true})
    {
        const std::string whole = dir / "whole.rawlog";
        format1 ? test::writeActionsAndFrames(whole, kFrames)
                : test::writeObservations(whole, kFrames);
        const std::string plain = test::decompressed(whole);
        for (const bool isGz : {false, true})
        {
            const std::string bytes = isGz ? test::readBytes(whole) : plain;
            for (const Damage damage :
                 {Damage::Cut, Damage::FlippedBit, Damage::ZeroedBytes, Damage::ForeignBytes})
            {
                for (int i = 0; i < kEach * share; ++i)
                {
                    const std::string path = dir / "damaged.rawlog";
                    const std::string out = dir / "out.rawlog";
                    test::writeBytes(path, damaged(bytes, damage, rng));
                    test::writeBytes(out, "old");
                    const Attempt a = attempt(runOdometry, {path, "-o", out, "--quiet"});
                    std::string wrong = wrongWith(a) + wrongIfFine(a, path, isGz, plain) +
                                        unless(a.code != 3, "exit code 3");
                    // What was read is written; a run that came to nothing leaves nothing.
                    const bool replaced = test::readBytes(out) != "old";
                    wrong += unless(a.code > 1 || replaced, "no output");
                    wrong += unless(a.code < 2 || !replaced, "the earlier output is lost");
                    wrong += unless(!std::filesystem::exists(out + ".partial"), "partial file");
                    tally.add(
                        a,
                        wrong,
                        std::string(format1 ? "format 1" : "format 2") + (isGz ? ", gz" : "") +
                            ", damage " + std::to_string(static_cast<int>(damage)) + ", number " +
                            std::to_string(i));
                }
            }
        }
    }
    return tally;
}
}  // namespace pointplane::adversary
