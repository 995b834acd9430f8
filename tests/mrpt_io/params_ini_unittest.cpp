// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/mrpt_io/LoadableParams.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/params_ini.h>

#include <mrpt/config/CConfigFileMemory.h>

#include <clocale>
#include <map>
#include <sstream>
#include <string>

#include "TempDir.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
using testing::HasSubstr;

struct Alpha
{
    int count{3};
    double gain{0.5};
    template <class V>
    void visit(V&& v)
    {
        v("count", count, "-", "how many");
        v("gain", gain, "1/m", "how strong");
    }
    void check() const
    {
        if (count < 0)
        {
            throw std::invalid_argument("[Alpha] count is negative");
        }
    }
};
struct Beta
{
    bool enabled{true};
    std::string name{"surf"};
    template <class V>
    void visit(V&& v)
    {
        v("enabled", enabled, "-", "whether");
        v("name", name, "-", "which");
    }
};
struct Params
{
    Alpha alpha;
    Beta beta;
    template <class F>
    void visitSections(F&& f)
    {
        f("Alpha", alpha);
        f("Beta", beta);
    }
};

std::string errorOf(const std::string& text)
{
    Params params;
    try
    {
        parseIni(text, "x.ini", parametersOf(params));
    }
    catch (const InputError& e)
    {
        return e.what();
    }
    return "no error";
}

TEST(ParamsIni, readsEveryTypeAndComments)
{
    Params params;
    parseIni(
        "# whole line\n; also\n// and this\n\n[Alpha]\ncount = -7 // seven\n  gain=2.5e-3\r\n"
        "[ Beta ]\nenabled = false\nname = orb // not surf\n",
        "x.ini",
        parametersOf(params));
    EXPECT_EQ(params.alpha.count, -7);
    EXPECT_DOUBLE_EQ(params.alpha.gain, 2.5e-3);
    EXPECT_FALSE(params.beta.enabled);
    EXPECT_EQ(params.beta.name, "orb");
}

TEST(ParamsIni, readsBehindAByteOrderMark)
{
    EXPECT_EQ(errorOf("\xEF\xBB\xBF[Alpha]\ncount = 1\n"), "no error");
    EXPECT_EQ(errorOf("\xEF\xBB\xBF\ncount = 1\n"), "x.ini:2: key 'count' before any [Section]");
}

TEST(ParamsIni, mistakesAreNamedWithFileLineAndWhatWasMeant)
{
    EXPECT_EQ(
        errorOf("[Alpha]\n\ngian = 1\n"),
        "x.ini:3: unknown key 'gian' in [Alpha]; did you mean 'gain'?");
    EXPECT_EQ(
        errorOf("[Alpha]\nname = orb\n"),
        "x.ini:2: unknown key 'name' in [Alpha]; it belongs in [Beta]");
    EXPECT_EQ(errorOf("[Alhpa]\n"), "x.ini:1: unknown section [Alhpa]; did you mean [Alpha]?");
    EXPECT_EQ(errorOf("[Nope]\n"), "x.ini:1: unknown section [Nope]; sections are Alpha, Beta");
    EXPECT_THAT(
        errorOf("[Alpha]\nwidth = 1\n"),
        testing::StartsWith("x.ini:2: unknown key 'width' in [Alpha]; keys are "));
    EXPECT_EQ(errorOf("[Alpha\n"), "x.ini:1: expected [SECTION] alone, not [Alpha");
    EXPECT_EQ(errorOf("count = 1\n"), "x.ini:1: key 'count' before any [Section]");
    EXPECT_EQ(errorOf("[Alpha]\ncount\n"), "x.ini:2: expected 'key = value', found 'count'");
    EXPECT_EQ(
        errorOf("[Alpha]\ncount = 1\ncount = 2\n"),
        "x.ini:3: key 'count' appears twice in [Alpha]");
}

TEST(ParamsIni, valuesMustBeWhatTheKeyTakes)
{
    for (const char* bad : {"3.7", "abc", "", "0x1q", "1 2", "-"})
    {
        EXPECT_THAT(
            errorOf(std::string("[Alpha]\ncount = ") + bad),
            HasSubstr("x.ini:2: [Alpha] count = '" + std::string(bad) + "' is not a whole number"));
    }
    for (const char* large : {"99999999999", "-99999999999"})
    {
        EXPECT_EQ(
            errorOf(std::string("[Alpha]\ncount = ") + large),
            "x.ini:2: [Alpha] count = '" + std::string(large) + "' is too large a number");
    }
    for (const char* bad : {"0,25", "abc", "nan", "inf", "1e999", "2.5 m"})
    {
        EXPECT_THAT(errorOf(std::string("[Alpha]\ngain = ") + bad), HasSubstr("is not a number"));
    }
    EXPECT_THAT(errorOf("[Alpha]\ngain = 2.5 # strong"), HasSubstr("starts with //"));
    EXPECT_THAT(errorOf("[Beta]\nenabled = maybe"), HasSubstr("is not true or false"));
}

TEST(ParamsIni, writtenTextReadsBackTheSame)
{
    Params params;
    params.alpha.gain = 1.0 / 3;
    params.alpha.count = 12;
    params.beta = {false, "orb"};
    const std::string text = iniText(parametersOf(params));
    EXPECT_THAT(text, HasSubstr("// [1/m] how strong"));
    Params back;
    parseIni(text, "x.ini", parametersOf(back));
    EXPECT_EQ(back.alpha.gain, params.alpha.gain);
    EXPECT_EQ(back.alpha.count, 12);
    EXPECT_FALSE(back.beta.enabled);
    EXPECT_EQ(back.beta.name, "orb");
    EXPECT_EQ(iniText(parametersOf(back)), text);
}

TEST(ParamsIni, settingsOverrideOneKey)
{
    Params params;
    applySettings({"Alpha.gain=7", "Beta.name = akaze"}, parametersOf(params));
    EXPECT_EQ(params.alpha.gain, 7.0);
    EXPECT_EQ(params.beta.name, "akaze");
    for (const char* wrong : {"Alpha.gain", "gain=7", "Alpha.gian=7"})
    {
        EXPECT_THROW(applySettings({wrong}, parametersOf(params)), InputError) << wrong;
    }
}

TEST(ParamsIni, aKeyThatIsSetTwiceIsAnError)
{
    Params params;
    try
    {
        applySettings({"Alpha.gain=7", "Beta.name=orb", "Alpha.gain = 7"}, parametersOf(params));
        ADD_FAILURE() << "taken";
    }
    catch (const InputError& e)
    {
        EXPECT_STREQ(e.what(), "setting 'Alpha.gain = 7': [Alpha] gain is set twice");
    }
    EXPECT_THROW(
        (void)loadOdometryParams("", {"PoseSolver.alpha=2", "PoseSolver.alpha=3"}), InputError);
}

TEST(ParamsIni, missingFileIsAnError)
{
    const test::TempDir dir;
    for (const std::string& path : {dir / "none.ini", dir / ""})
    {
        try
        {
            (void)loadOdometryParams(path);
            FAIL();
        }
        catch (const InputError& e)
        {
            EXPECT_THAT(e.what(), HasSubstr("cannot open configuration " + path));
        }
    }
}

TEST(ParamsIni, anotherFileIsNotQuoted)
{
    const test::TempDir dir;
    for (const auto& bytes : {std::string("\x1f\x8b\x08gz"), std::string("a\0b", 3)})
    {
        test::writeBytes(dir / "a.rawlog", bytes);
        const auto read = [&] { (void)loadOdometryParams(dir / "a.rawlog"); };
        EXPECT_THAT(
            read,
            testing::ThrowsMessage<InputError>(
                dir / "a.rawlog" + ": is not a text, as a configuration is"));
    }
}

/** Nor read to the end of a large one; and a disk that fails is told with the file. */
TEST(ParamsIni, aFileThatIsTooLargeOrCannotBeReadIsNamed)
{
    const test::TempDir dir;
    const std::string large = dir / "large.txt";
    test::writeBytes(large, "[Lens]\n" + std::string(2U << 20U, '#'));
    EXPECT_THAT(
        [&] { (void)loadOdometryParams(large); },
        testing::ThrowsMessage<InputError>(
            large + ": is longer than 1 MiB, as no configuration is"));
    EXPECT_THAT(
        [&] { (void)loadOdometryParams("/proc/self/mem"); },
        testing::ThrowsMessage<InputError>(
            HasSubstr("cannot read configuration /proc/self/mem: ")));
}

TEST(ParamsIni, odometryParametersRoundTripAndAreChecked)
{
    OdometryParams params = loadOdometryParams("");
    const ParameterTable table = parametersOf(params);
    EXPECT_GT(table.size(), 10U);
    for (const ParameterRef& p : table)
    {
        EXPECT_FALSE(p.help.empty()) << p.section << "." << p.key;
        EXPECT_FALSE(p.unit.empty()) << p.section << "." << p.key;
    }
    const test::TempDir dir;
    test::writeBytes(dir / "a.ini", iniText(table));
    OdometryParams back = loadOdometryParams(dir / "a.ini");
    EXPECT_EQ(iniText(parametersOf(back)), iniText(table));
    // A value out of range is refused with its name.
    try
    {
        (void)loadOdometryParams("", {"DepthNoise.sigmaInverseDepth=-1"});
        FAIL();
    }
    catch (const InputError& e)
    {
        EXPECT_THAT(e.what(), HasSubstr("sigmaInverseDepth"));
    }
}

/** As every other mistake. */
TEST(OdometryParamsIni, whereAValueOutOfRangeComesFromIsTold)
{
    const test::TempDir dir;
    const std::string path = dir / "c.ini";
    test::writeBytes(path, "[Pipeline]\n\n[PoseSolver]\nalpha = -3 // too small\n");
    const auto problemOf = [&](const std::string& file, const std::vector<std::string>& settings)
    {
        try
        {
            (void)loadOdometryParams(file, settings);
        }
        catch (const InputError& e)
        {
            return std::string(e.what());
        }
        return std::string();
    };
    const std::string wrong = ": [PoseSolver] alpha = -3 is not in [0, 1000]";
    EXPECT_EQ(problemOf(path, {}), path + ":4" + wrong);
    EXPECT_EQ(problemOf(path, {"PoseSolver.alpha=-3"}), "setting 'PoseSolver.alpha=-3'" + wrong);
    EXPECT_EQ(problemOf("", {"PoseSolver.alpha=-3"}), "setting 'PoseSolver.alpha=-3'" + wrong);
    EXPECT_EQ(problemOf(path, {"PoseSolver.alpha=3"}), "");
}

TEST(OdometryParamsIni, everyNumberHasARange)
{
    OdometryParams params;
    for (const auto& p : parametersOf(params))
    {
        const std::string key = p.section + "." + p.key;
        const bool isInt = std::holds_alternative<int*>(p.value);
        if (!isInt && !std::holds_alternative<double*>(p.value))
        {
            continue;
        }
        for (const char* value : {isInt ? "2147483647" : "1e12", isInt ? "-2147483648" : "-1e12"})
        {
            try
            {
                (void)loadOdometryParams("", {key + "=" + value});
                ADD_FAILURE() << key << " may be " << value;
            }
            catch (const InputError& e)
            {
                EXPECT_THAT(e.what(), HasSubstr("[" + p.section + "] " + p.key + " = "));
            }
        }
    }
}

TEST(OdometryParamsIni, lengthsInMillimetresAreToldApart)
{
    OdometryParams params;
    std::map<std::string, std::string> wrong{
        {"minDepth", "400"},
        {"maxDepth", "8000"},
        {"keyframeDistance", "150"},
        {"maxDistance", "100"},
        {"sigmaDepth", "2"}};
    for (const auto& p : parametersOf(params))
    {
        if (p.unit != "m")
        {
            continue;
        }
        const std::string value = wrong.at(p.key);
        std::ostringstream metres;
        metres << std::stod(value) / 1000;
        try
        {
            (void)loadOdometryParams("", {p.section + "." + p.key + "=" + value});
            ADD_FAILURE() << p.key << " may be " << value;
        }
        catch (const InputError& e)
        {
            EXPECT_THAT(
                e.what(),
                HasSubstr("[" + p.section + "] " + p.key + " = " + value + " is not in ["));
            EXPECT_THAT(
                e.what(),
                HasSubstr("]: it is in metres, and " + value + " mm are " + metres.str()));
        }
        wrong.erase(p.key);
    }
    EXPECT_TRUE(wrong.empty()) << wrong.begin()->first;
}

/** Where a value is no length in any unit, none is guessed. */
TEST(OdometryParamsIni, aLengthThatIsNoneInMillimetresIsOutOfRange)
{
    try
    {
        (void)loadOdometryParams("", {"PointLifter.maxDepth=-8"});
        ADD_FAILURE();
    }
    catch (const InputError& e)
    {
        EXPECT_THAT(e.what(), testing::EndsWith("maxDepth = -8 is not in [0.001, 200]"));
    }
}

TEST(LoadableParams, worksAsMrptsLoadableOptions)
{
    mrpt::config::CConfigFileMemory ini(std::string("[any]\ncount = 9 // nine\ngain=0.25\n"));
    LoadableParams<Alpha> params;
    params.loadFromConfigFile(ini, "any");
    EXPECT_EQ(params.values.count, 9);
    EXPECT_EQ(params.values.gain, 0.25);
    mrpt::config::CConfigFileMemory out;
    params.saveToConfigFile(out, "any");
    EXPECT_EQ(out.read_int("any", "count", 0), 9);
    mrpt::config::CConfigFileMemory typo(std::string("[any]\ncuont = 9\n"));
    EXPECT_THROW(params.loadFromConfigFile(typo, "any"), InputError);
}

/** The program has an ini file of its own, so lines are not known; values stay as they were. */
TEST(LoadableParams, mistakesNameSectionAndKeyAndChangeNothing)
{
    LoadableParams<Alpha> params;
    const Alpha before = params.values;
    for (const auto& [text, message] :
         {std::pair("count = -1", "[any] [Alpha] count is negative"),
          std::pair("gain = 0.25\ncuont = 9", "unknown key 'cuont' in [any]; did you mean"),
          std::pair("gain = 0.25\ncount = x", "[any] count = 'x' is not a whole number")})
    {
        mrpt::config::CConfigFileMemory ini("[other]\na=1\n[any]\n" + std::string(text) + "\n");
        EXPECT_THAT(
            [&] { params.loadFromConfigFile(ini, "any"); },
            testing::ThrowsMessage<InputError>(testing::StartsWith(message)));
        EXPECT_EQ(params.values.count, before.count);
        EXPECT_EQ(params.values.gain, before.gain);
    }
}
}  // namespace
}  // namespace pointplane
