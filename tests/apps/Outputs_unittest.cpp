// SPDX-License-Identifier: BSD-3-Clause
// No output destroys anything: of pointplane-odometry, whose outputs are all others' outputs, too.
#include <pointplane/mrpt_io/OutputFile.h>
#include <pointplane/mrpt_io/OutputFolder.h>
#include <pointplane/mrpt_io/errors.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <future>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "OdometryApp.h"
#include "OutputGuard.h"
#include "TempDir.h"
#include "rawlog_samples.h"
#include "run_app.h"
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

namespace pointplane
{
namespace
{
namespace fs = std::filesystem;
using test::AppRun;
using test::readBytes;
using test::runApp;
using test::writeBytes;
using testing::HasSubstr;

const std::vector<std::string> kOptions{
    "-o", "--trajectory", "--diagnostics", "--graph", "--simplemap"};

class Outputs : public testing::Test
{
 protected:
    void SetUp() override
    {
        fs::create_directory(dir_ / "in");
        test::writeObservations(in_, 3);
        writeBytes(config_, "[Covariance]\n");
    }

    [[nodiscard]] static AppRun run(std::vector<std::string> args)
    {
        args.emplace_back("--quiet");
        return runApp(runOdometry, args);
    }

    /** Names of the files in the folder of the test, and in those below. */
    [[nodiscard]] std::vector<std::string> files() const
    {
        std::vector<std::string> out;
        for (const auto& entry : fs::recursive_directory_iterator(dir_ / ""))
        {
            out.push_back(entry.path());
        }
        std::sort(out.begin(), out.end());
        return out;
    }

    /** Refused in one line, with every file as it was. */
    void expectRefused(const std::vector<std::string>& args, const std::string& why)
    {
        const auto before = files();
        const std::string input = readBytes(in_), config = readBytes(config_);
        const AppRun outcome = run(args);
        std::string line;
        for (const std::string& arg : args)
        {
            line += arg + " ";
        }
        EXPECT_EQ(outcome.code, kExitBadInput) << line << outcome.err;
        EXPECT_THAT(outcome.err, HasSubstr(why)) << line;
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
        EXPECT_EQ(files(), before) << line;
        EXPECT_EQ(readBytes(in_), input) << line;
        EXPECT_EQ(readBytes(config_), config) << line;
    }

    test::TempDir dir_;
    std::string in_{dir_ / "in/a.rawlog"};
    std::string config_{dir_ / "in/c.ini"};
    std::string out_{dir_ / "out"};
};

/** What the project's own programs write beside a rawlog. */
TEST_F(Outputs, noneIsTheGroundTruthBesideAnInput)
{
    const std::string truth = dir_ / "in/a.groundtruth.txt";
    writeBytes(truth, "# truth\n");
    for (const std::string& option : kOptions)
    {
        expectRefused({in_, option, truth}, option + " " + truth + ": is an input");
    }
    EXPECT_EQ(readBytes(truth), "# truth\n");
}

TEST_F(Outputs, noneIsAnInputByAnyName)
{
    fs::create_symlink(in_, dir_ / "symbolic");
    fs::create_hard_link(in_, dir_ / "hard");
    fs::create_directory_symlink(dir_ / "in", dir_ / "folder");
    fs::create_symlink("symbolic", dir_ / "chain");
    for (const std::string& option : kOptions)
    {
        for (const std::string& name :
             {in_,
              dir_ / "symbolic",
              dir_ / "hard",
              dir_ / "folder/a.rawlog",
              dir_ / "chain",
              dir_ / "in/../in/./a.rawlog"})
        {
            expectRefused({in_, option, name}, option + " " + name + ": is an input");
            expectRefused({name, option, in_}, option + " " + in_ + ": is an input");
        }
        expectRefused({in_, "-c", config_, option, config_}, "is an input");
    }
}

TEST_F(Outputs, noneIsMadeOverAnInput)
{
    const std::string partial = dir_ / "in/q.rawlog.partial";
    fs::copy(in_, partial);
    for (const std::string& option : kOptions)
    {
        expectRefused({partial, option, dir_ / "in/q.rawlog"}, "would write over the input");
        expectRefused({in_, partial, option, dir_ / "in/q.rawlog"}, "would write over the input");
    }
    EXPECT_EQ(readBytes(partial), readBytes(in_));
}

TEST_F(Outputs, noTwoAreTheSame)
{
    fs::create_symlink("out", dir_ / "link");
    for (const std::string& a : kOptions)
    {
        for (const std::string& b : kOptions)
        {
            if (a != b)
            {
                expectRefused({in_, a, out_, b, out_}, "would write over what");
                expectRefused({in_, a, out_, b, dir_ / "link"}, "would write over what");
                const bool isOfMap = a == "-o" && b == "--simplemap";  // told by its name first
                expectRefused(
                    {in_, a, out_, b, out_ + ".partial"},
                    isOfMap ? "would be a simplemap" : "would write over what");
            }
        }
    }
}

TEST_F(Outputs, picturesDoNotReplaceImagesOfTheRawlog)
{
    const std::string images = dir_ / "in/b_Images";
    fs::create_directory(images);
    const std::string external = dir_ / "in/b.rawlog";
    {
        RawlogWriter writer(external);
        const auto scan = test::sampleScan(0);
        ASSERT_TRUE(scan->intensityImage.saveToFile(images + "/000000.jpg"));
        scan->intensityImage.setExternalStorage("000000.jpg");
        writer.write(*scan);
        writer.close();
    }
    const std::string image = readBytes(images + "/000000.jpg");
    expectRefused({external, "--overlay", images}, "is an input");
    expectRefused({external, "--overlay", images + "/"}, "is an input");
    expectRefused(
        {external, "--trajectory", images + "/000000.jpg"}, "in the folder of the inputs");
    EXPECT_EQ(readBytes(images + "/000000.jpg"), image);
    // The names in an output are absolute: the images are elsewhere then.
    ASSERT_EQ(run({external, "-o", out_}).code, kExitOk);
    expectRefused({out_, "--overlay", images}, "would write over the input");
    expectRefused({out_, "--trajectory", images + "/000000.jpg"}, "is an input");
    EXPECT_EQ(readBytes(images + "/000000.jpg"), image);
}

TEST_F(Outputs, whatCannotBeWrittenIsRefusedBeforeTheRun)
{
    fs::create_directory(dir_ / "folder");
    for (const std::string& option : kOptions)
    {
        expectRefused({in_, option, dir_ / "folder"}, "is a folder");
        const auto before = files();
        const AppRun outcome = run({in_, "--overlay", dir_ / "pictures", option, "/nonexistent/x"});
        EXPECT_EQ(outcome.code, kExitEnvironment);
        EXPECT_THAT(
            outcome.err,
            HasSubstr(option + ": cannot write /nonexistent/x: there is no folder /nonexistent"));
        EXPECT_EQ(files(), before);
    }
    expectRefused({in_, "--overlay", in_}, "is not a folder");
    expectRefused({in_, "--trajectory", "-"}, "--trajectory -: give /dev/stdout");
}

/** As a trajectory's: what is written is a rawlog, whatever its name says. */
TEST_F(Outputs, aRawlogHasTheNameOfOne)
{
    writeBytes(dir_ / "in/truth.txt", "precious");
    for (const char* name : {"in/truth.txt", "poses.tum", "a.txt.gz", "out.rawlog.gz2", ".txt"})
    {
        expectRefused(
            {in_, "-o", dir_ / name},
            "-o " + (dir_ / name) +
                ": would be a rawlog; give a name that ends in .rawlog or .rawlog.gz\n");
    }
    EXPECT_EQ(readBytes(dir_ / "in/truth.txt"), "precious");
    for (const char* name : {"out.rawlog", "out.rawlog.gz", "a.b.rawlog", "out", "dir.x/out"})
    {
        fs::create_directory(dir_ / "dir.x");
        EXPECT_EQ(run({in_, "-o", dir_ / name}).code, kExitOk) << name;
        EXPECT_TRUE(fs::exists(dir_ / name)) << name;
    }
    const std::string pipe = dir_ / "pipe.txt";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    auto reader = std::async(std::launch::async, [&] { return readBytes(pipe); });
    EXPECT_EQ(run({in_, "-o", pipe}).code, kExitOk);
    EXPECT_GT(reader.get().size(), 100U);
}

/** By which pointplane-eval and MRPT's programs know it. */
TEST_F(Outputs, aSimplemapHasTheNameOfOne)
{
    writeBytes(dir_ / "in/truth.txt", "precious");
    for (const char* name : {"in/truth.txt", "a.rawlog", "a.simplemap.txt", "a.gz"})
    {
        expectRefused(
            {in_, "--simplemap", dir_ / name},
            "--simplemap " + (dir_ / name) +
                ": would be a simplemap; give a name that ends in .simplemap or .simplemap.gz\n");
    }
    EXPECT_EQ(readBytes(dir_ / "in/truth.txt"), "precious");
    for (const char* name : {"a.simplemap", "a.simplemap.gz", "a"})
    {
        EXPECT_EQ(run({in_, "--simplemap", dir_ / name}).code, kExitOk) << name;
        EXPECT_TRUE(fs::exists(dir_ / name)) << name;
    }
}

TEST_F(Outputs, aTextHasNotTheNameOfARawlogOrAnArchive)
{
    writeBytes(dir_ / "in/other.rawlog", "precious");
    for (const char* option : {"--trajectory", "--diagnostics", "--graph"})
    {
        for (const char* name : {"in/other.rawlog", "other.rawlog.gz", "poses.txt.gz"})
        {
            expectRefused(
                {in_, option, dir_ / name},
                option + (" " + (dir_ / name)) +
                    ": would be plain text; give a name that ends neither in .rawlog nor in .gz\n");
        }
    }
    EXPECT_EQ(readBytes(dir_ / "in/other.rawlog"), "precious");
}

/** What is wrong is the input, not where the output is. */
TEST_F(Outputs, aFolderAsAnInputIsBlamedItself)
{
    const std::string folder = dir_ / "in";
    for (const std::string& option : kOptions)
    {
        expectRefused({folder, option, dir_ / "in/new"}, "pointplane-convert folder makes one of");
        expectRefused({in_, folder, option, dir_ / "in/new"}, "is a folder, not a rawlog");
        expectRefused({in_, "-c", folder, option, dir_ / "in/new"}, "is a directory");
    }
}

TEST_F(Outputs, linksAreWrittenThrough)
{
    writeBytes(dir_ / "target", "old");
    fs::create_symlink("target", dir_ / "link");
    fs::create_symlink("target2", dir_ / "dangling");
    ASSERT_EQ(run({in_, "--trajectory", out_}).code, kExitOk);
    for (const char* name : {"link", "dangling"})
    {
        ASSERT_EQ(run({in_, "--trajectory", dir_ / name}).code, kExitOk) << name;
        EXPECT_TRUE(fs::is_symlink(dir_ / name)) << name;
        EXPECT_EQ(readBytes(dir_ / name), readBytes(out_)) << name;
    }
    EXPECT_EQ(readBytes(dir_ / "target2"), readBytes(out_));
}

TEST_F(Outputs, pipesAreWrittenThrough)
{
    for (const std::string& option : kOptions)
    {
        const std::string pipe = dir_ / "pipe";
        ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
        auto reader = std::async(std::launch::async, [&] { return readBytes(pipe); });
        const AppRun outcome = run({in_, option, pipe});
        EXPECT_EQ(outcome.code, kExitOk) << outcome.err;
        const std::string bytes = reader.get();
        EXPECT_TRUE(fs::is_fifo(pipe)) << option;
        ASSERT_EQ(run({in_, option, out_}).code, kExitOk);
        const std::string other = readBytes(out_);
        if (option == "--diagnostics")  // its times are as long as they are
        {
            EXPECT_EQ(
                std::count(bytes.begin(), bytes.end(), '\n'),
                std::count(other.begin(), other.end(), '\n'));
        }
        else
        {
            EXPECT_EQ(bytes.size(), other.size()) << option;
        }
        fs::remove(pipe);
        fs::remove(out_);
    }
}

/** A device that any user may make: what is written to it is read until close(). */
class Terminal
{
 public:
    Terminal() : master_(::posix_openpt(O_RDWR | O_NOCTTY))
    {
        if (master_ < 0 || ::grantpt(master_) != 0 || ::unlockpt(master_) != 0)
        {
            throw std::system_error(errno, std::generic_category(), "no terminal");
        }
        path = ::ptsname(master_);
        slave_ = ::open(path.c_str(), O_RDWR | O_NOCTTY);
        reader_ = std::thread(
            [this]
            {
                char buffer[4096];
                for (ssize_t n = 0; (n = ::read(master_, buffer, sizeof(buffer))) > 0;)
                {
                    numBytes_ += static_cast<std::size_t>(n);
                }
            });
    }
    ~Terminal()
    {
        (void)close();
        ::close(master_);
    }
    /** \return how many bytes have been written to it in all */
    std::size_t close()
    {
        if (reader_.joinable())
        {
            ::close(slave_);  // which ends the reader, once it has read everything
            reader_.join();
        }
        return numBytes_;
    }
    Terminal(const Terminal&) = delete;
    Terminal& operator=(const Terminal&) = delete;

    std::string path;

 private:
    std::atomic<std::size_t> numBytes_{0};
    int master_, slave_{-1};
    std::thread reader_;
};

TEST_F(Outputs, devicesStayDevices)
{
    Terminal device;
    ASSERT_TRUE(fs::is_character_file(device.path));
    fs::create_symlink(device.path, dir_ / "link");
    std::vector<std::string> args{in_};
    for (const std::string& option : kOptions)
    {
        args.push_back(option);
        args.push_back(option == "-o" ? dir_ / "link" : device.path);  // all into one
    }
    const AppRun outcome = run(args);
    EXPECT_EQ(outcome.code, kExitOk) << outcome.err;
    EXPECT_TRUE(fs::is_character_file(device.path));
    EXPECT_TRUE(fs::is_symlink(dir_ / "link"));
    EXPECT_GT(device.close(), 1000U);
}

/** Also where nobody has named it: what an output is written to until it is complete. */
TEST_F(Outputs, aPartialNameThatIsSomethingElseIsLeftAlone)
{
    const std::string precious = dir_ / "precious", partial = out_ + ".partial";
    writeBytes(precious, "precious");
    const std::vector<std::function<void()>> kinds{
        [&] { fs::create_symlink("precious", partial); },
        [&] { fs::create_symlink("nothing", partial); },
        [&] { fs::create_hard_link(precious, partial); },
        [&] { ASSERT_EQ(::mkfifo(partial.c_str(), 0600), 0); },
        [&] { fs::create_directory(partial); }};
    for (std::size_t k = 0; k < kinds.size(); ++k)
    {
        kinds[k]();
        const auto before = files();
        for (const std::string& option : kOptions)
        {
            const AppRun outcome = run({in_, option, out_});
            EXPECT_EQ(outcome.code, kExitEnvironment) << k << option;
            EXPECT_THAT(outcome.err, HasSubstr(option + ": cannot create " + partial)) << k;
            EXPECT_EQ(files(), before) << k << option;
        }
        EXPECT_EQ(readBytes(precious), "precious") << k;
        fs::remove(partial);
    }
}

TEST_F(Outputs, twoProgramsDoNotWriteOneFile)
{
    OutputFile first(out_);
    first.write("first", 5);
    for (const std::string& option : kOptions)
    {
        const AppRun outcome = run({in_, option, out_});
        EXPECT_EQ(outcome.code, kExitEnvironment) << option;
        EXPECT_THAT(outcome.err, HasSubstr("another program is writing it")) << option;
    }
    first.commit();
    EXPECT_EQ(readBytes(out_), "first");
    EXPECT_EQ(run({in_, "--trajectory", out_}).code, kExitOk);
    EXPECT_NE(readBytes(out_), "first");
}

/** What is refused before the first frame has not begun to write. */
TEST_F(Outputs, aRefusedRunLeavesNoPartialFiles)
{
    for (const std::string& option : kOptions)
    {
        expectRefused({in_, option, out_, "--mask", dir_ / "none.png"}, "none.png: no such file");
    }
    // The size of the images is known when the first one is read.
    writeBytes(dir_ / "mask.pgm", "P2 2 1 255\n0 255\n");
    expectRefused(
        {in_, "--overlay", dir_ / "pictures", "--mask", dir_ / "mask.pgm"}, "is 2x1, but images");
    EXPECT_FALSE(fs::exists(dir_ / "pictures"));
    const OutputFile first(out_);
    const auto before = files();
    const AppRun outcome = run({in_, "-o", dir_ / "b.rawlog", "--diagnostics", out_});
    EXPECT_EQ(outcome.code, kExitEnvironment);
    EXPECT_THAT(outcome.err, HasSubstr("another program is writing it"));
    EXPECT_EQ(files(), before);
}

/** Nobody named the files in it. */
TEST_F(Outputs, linksInAFolderAreReplacedAndNotFollowed)
{
    const std::string folder = dir_ / "pictures", input = readBytes(in_);
    fs::create_directory(folder);
    fs::create_symlink("../in/a.rawlog", folder + "/000000.jpg");
    fs::create_symlink("../nothing", folder + "/000001.jpg");
    fs::create_hard_link(in_, folder + "/000002.jpg");
    const AppRun outcome = run({in_, "--overlay", folder});
    EXPECT_EQ(outcome.code, kExitOk) << outcome.err;
    EXPECT_EQ(readBytes(in_), input);
    EXPECT_FALSE(fs::exists(dir_ / "nothing"));
    for (const char* name : {"/000000.jpg", "/000001.jpg", "/000002.jpg"})
    {
        EXPECT_EQ(fs::symlink_status(folder + name).type(), fs::file_type::regular) << name;
        EXPECT_EQ(readBytes(folder + name).substr(0, 2), "\xFF\xD8") << name;
    }
}

TEST_F(Outputs, twoProgramsDoNotWriteIntoOneFolder)
{
    const std::string folder = dir_ / "pictures";
    {
        const OutputFolder first(folder);
        const auto before = files();
        const AppRun outcome = run({in_, "--overlay", folder});
        EXPECT_EQ(outcome.code, kExitEnvironment);
        EXPECT_EQ(
            outcome.err,
            "pointplane-odometry: --overlay: cannot write into " + folder +
                ": another program is writing there\n");
        EXPECT_EQ(files(), before);
    }
    EXPECT_EQ(run({in_, "--overlay", folder}).code, kExitOk);
}

TEST_F(Outputs, aReplacedFileKeepsItsPermissions)
{
    writeBytes(out_, "old");
    fs::permissions(out_, fs::perms::owner_read | fs::perms::owner_write);
    ASSERT_EQ(run({in_, "--trajectory", out_}).code, kExitOk);
    EXPECT_EQ(fs::status(out_).permissions(), fs::perms::owner_read | fs::perms::owner_write);
    EXPECT_NE(readBytes(out_), "old");
}

TEST_F(Outputs, aRunThatComesToNothingLeavesNothing)
{
    writeBytes(out_, "old");
    const auto before = files();
    for (const std::string& option : kOptions)
    {
        const AppRun outcome = run({in_, "--sensor-label", "X", option, out_});
        EXPECT_EQ(outcome.code, kExitBadInput);
        EXPECT_EQ(files(), before) << option;
        EXPECT_EQ(readBytes(out_), "old");
    }
}

/** In a process of its own, with a limit on the size of files, as by ulimit -f. */
TEST_F(Outputs, aLimitOnTheSizeOfFilesIsExitCode3)
{
    test::writeObservations(in_, 40);
    for (const std::string& option : kOptions)
    {
        writeBytes(out_, "old");
        const pid_t child = ::fork();
        if (child == 0)
        {
            std::signal(SIGXFSZ, SIG_IGN);  // as runProgram() does
            const rlimit limit{1024, 1024};
            ::setrlimit(RLIMIT_FSIZE, &limit);
            const AppRun outcome = run({in_, option, out_});
            const bool told = outcome.err.find("File too large") != std::string::npos;
            ::_exit(told ? outcome.code : 99);
        }
        int status = 0;
        ASSERT_EQ(::waitpid(child, &status, 0), child);
        EXPECT_TRUE(WIFEXITED(status)) << option;
        EXPECT_EQ(WEXITSTATUS(status), kExitEnvironment) << option;
        EXPECT_EQ(readBytes(out_), "old") << option;
    }
}

/** Also of files that are not there yet. */
TEST(OutputGuard, aFileHasRelativeAndAbsoluteNames)
{
    const test::TempDir dir;
    const fs::path before = fs::current_path();
    fs::create_directory(dir / "sub");
    fs::current_path(dir / "sub");
    const std::string absolute = dir / "sub/new";
    const std::vector<std::string> names{"new", "./new", "../sub/new", absolute};
    for (const std::string& a : names)
    {
        for (const std::string& b : names)
        {
            OutputGuard guard;
            guard.addOutput("-o", a);
            EXPECT_THROW(guard.addOutput("--trajectory", b), InputError) << a << " " << b;
        }
    }
    OutputGuard guard;
    guard.addInputFolder(".");
    EXPECT_THROW(guard.addOutput("-o", "new"), InputError);
    EXPECT_THROW(guard.addOutput("-o", absolute), InputError);
    EXPECT_NO_THROW(guard.addOutput("-o", "../new"));
    fs::current_path(before);
}

TEST(OutputGuard, anyOrderOfInputsAndOutputs)
{
    const test::TempDir dir;
    writeBytes(dir / "a", "a");
    OutputGuard first, second;
    first.addInput(dir / "a");
    EXPECT_THROW(first.addOutput("-o", dir / "a"), InputError);
    second.addOutput("-o", dir / "a");
    EXPECT_THROW(second.addInput(dir / "a"), InputError);
    EXPECT_NO_THROW(second.addInput(dir / "b"));
    EXPECT_NO_THROW(second.addInput(""));
    EXPECT_NO_THROW(second.addOutput("-o", ""));
}
}  // namespace
}  // namespace pointplane
