"""Recomputes thresholds from counts of right answers, and their means over people, as defined in docs/thresholds.md.
Called by scripts/crosscheck-procedures. No quadrature of the program is used.
"""

import argparse, csv, json, math, os, sys
import numpy as np
from scipy import interpolate, optimize, special, stats

# --- Definitions of docs/thresholds.md ---

WIDTHS = (2.0, 60.0)  # dB, from F = .05 to .95
TYPICAL_WIDTH = stats.lognorm(s=0.8, scale=10)
LAPSES = (0.0, 0.5)
ANY_LAPSE = stats.beta(1, 3)
TYPICAL_LAPSE = stats.beta(1, 10)
BEYOND = 20.0  # dB by which thresholds are extended on either side, or the range of the levels
LOSS = stats.chi2.ppf(0.95, 1) / 2
WIDTH_AT_ONE = {"weibull": 20 * (math.log10(-math.log(0.05)) - math.log10(-math.log(0.95))),
                "logistic": 2 * math.log(19), "normal": 2 * stats.norm.isf(0.05)}


# --- One track ---

def rises(shape, z):
    """F and 1 - F."""
    if shape == "weibull":
        power = 10 ** (np.minimum(z, 80) / 20)
        return -np.expm1(-power), np.exp(-power)
    if shape == "logistic":
        return special.expit(z), special.expit(-z)
    return special.ndtr(z), special.ndtr(-z)


def nodes(low, high, n):
    at, weights = np.polynomial.legendre.leggauss(n)
    return low + (at + 1) * (high - low) / 2, weights * (high - low) / 2


class Averages:
    """Logarithms of the likelihood of thresholds, averaged over three kinds of observers, as splines."""

    def __init__(self, counts, levels, guess, shape, step=0.2, n=32):
        span = max(max(levels) - min(levels), BEYOND)
        low, high = min(levels) - span, max(levels) + span
        self.t = np.linspace(low, high, round((high - low) / step) + 1)
        log_width, width_weights = nodes(*np.log(WIDTHS), n)
        lapse, lapse_weights = nodes(*LAPSES, n)
        width = np.exp(log_width)
        value = np.zeros((self.t.size, n, n))
        for level, right, given in counts:
            up, down = rises(shape, WIDTH_AT_ONE[shape] / width * (level - self.t[:, None]))
            up, down = up[:, :, None], down[:, :, None]
            if right > 0:
                value += right * np.log(guess + (1 - guess - lapse) * up)
            if given > right:
                value += (given - right) * np.log((1 - guess) * down + lapse * up)
        top = value.max(axis=(1, 2))
        likelihood = np.exp(value - top[:, None, None])
        any_width_weights = width_weights * width * width ** 0.5  # the nodes are of the logarithm
        typical_lapse_weights = lapse_weights * TYPICAL_LAPSE.pdf(lapse)

        def average(of_width, of_lapse):
            return interpolate.CubicSpline(self.t, top + np.log((likelihood @ of_lapse) @ of_width))

        self.any = average(any_width_weights, lapse_weights * ANY_LAPSE.pdf(lapse))
        self.typical_lapses = average(any_width_weights, typical_lapse_weights)
        self.typical = average(width_weights * width * TYPICAL_WIDTH.pdf(width), typical_lapse_weights)

    def top(self, log):
        peaks = [x for x in log.derivative().roots(extrapolate=False) if np.isfinite(x)]
        return log([self.t[0], self.t[-1], *peaks]).max()

    def rise(self):
        """The loss of log likelihood beyond LOSS for typical observers who feel all levels, or none: the smaller one."""
        return self.top(self.typical) - LOSS - max(self.typical([self.t[0], self.t[-1]]))

    def interval(self, log):
        """The first and last threshold with a loss of at most LOSS; infinite at the end of the extended levels."""
        limit = self.top(log) - LOSS
        inside = np.flatnonzero(log(self.t) >= limit)
        first, last = inside[0], inside[-1]

        def crossing(i):
            return optimize.brentq(lambda t: log(t) - limit, self.t[i], self.t[i + 1], xtol=1e-10)

        return (-math.inf if first == 0 else crossing(first - 1),
                math.inf if last == self.t.size - 1 else crossing(last))

    def border(self, number, first, last):
        """The smallest log-likelihood difference that decides a state."""
        limits = [(log, self.top(log) - LOSS) for log in (self.any, self.typical_lapses)]
        ends = [abs(log(x) - limit) for log, limit in limits for x in (first, last, self.t[0], self.t[-1])]
        numbers = [abs(self.typical(number) - self.typical(x)) for x in (first, last)]
        return min(abs(self.rise()), *ends, *numbers)

    def likeliest(self, low, high):
        """The typical observers' threshold between these."""
        low, high = max(low, self.t[0]), min(high, self.t[-1])
        peaks = self.typical.derivative().roots(extrapolate=False)
        return max([low, high, *peaks[(peaks > low) & (peaks < high)]], key=self.typical)


def estimate(counts, levels, guess, shape):
    """A track's number and interval, or its side; its bounds for means; the likelihoods; and the smallest
    log-likelihood difference that decides between two states."""
    averages = Averages(counts, levels, guess, shape)
    ends, typical_ends = averages.interval(averages.any), averages.interval(averages.typical_lapses)
    number = averages.likeliest(*ends)
    first, last = min(levels), max(levels)

    def inside(x):
        return first <= x <= last

    low, high = (end if math.isfinite(end) else None for end in ends)
    if first < number < last and averages.rise() > 0:
        state = "no"
    else:
        low, high = (end if inside(end) else None for end in ends)
        state = "above" if max(ends[0], typical_ends[0]) >= last else \
            "below" if ends[1] <= first else "undetermined"
    if state == "above":
        low, high = last, None
    if state == "below":
        low, high = None, first
    if not inside(number):
        bounds = (last, math.inf) if number > last else (-math.inf, first)
    else:
        bounds = (number, number) if state == "no" or any(map(inside, typical_ends)) else (-math.inf, math.inf)
    return {"level": number if state == "no" else None, "low": low, "high": high, "censored": state,
            "at_least": bounds[0], "at_most": bounds[1], "averages": averages,
            "border": averages.border(number, first, last)}


# --- Means over people ---

class CensoredNormal:
    """Likelihood of a mean and an SD, given each person's bounds: equal ones are known values."""

    def __init__(self, bounds):
        bounds = np.asarray(bounds, float)
        known = bounds[:, 0] == bounds[:, 1]
        self.known, self.cut, self.m = bounds[known, 0], bounds[~known], known.sum()
        start = self.known.mean(), math.log(max(self.known.std(), 0.1))
        # From several starts, because tails can create a second maximum.
        found = [optimize.minimize(lambda at: -self.at(*at), (start[0] + shift, start[1] + grow), method="Nelder-Mead",
                                   options={"xatol": 1e-10, "fatol": 1e-13, "maxiter": 4000, "maxfev": 4000})
                 for shift, grow in ((0, 0), (0, 0.7), (math.exp(start[1]), 0.3), (-math.exp(start[1]), 0.3))]
        best = min(found, key=lambda one: one.fun)
        self.mean, self.sd, self.max_log = best.x[0], math.exp(best.x[1]), -best.fun

    def at(self, mean, log_sd):
        sd = math.exp(log_sd)
        value = -len(self.known) * log_sd - ((self.known - mean) ** 2).sum() / (2 * sd * sd)
        low, high = (self.cut - mean).T / sd
        mirrored = low > 0  # the lower tail has all digits
        a, b = special.log_ndtr(np.where(mirrored, -high, low)), special.log_ndtr(np.where(mirrored, -low, high))
        return value + (b + np.log(-np.expm1(np.minimum(a - b, -1e-300)))).sum()

    def ratio(self, mean):
        """Twice the loss of log likelihood of the best SD for this mean."""
        middle = math.log(math.hypot(self.sd, mean - self.mean))
        best = optimize.minimize_scalar(lambda log_sd: -self.at(mean, log_sd), bounds=(middle - 3, middle + 3),
                                        method="bounded", options={"xatol": 1e-10})
        return 2 * (self.max_log + best.fun)

    def interval(self):
        """Ends where the ratio is that of Student's interval of the known values."""
        limit = self.m * math.log1p(stats.t.ppf(0.975, self.m - 1) ** 2 / (self.m - 1))
        return [self.end(sign, limit) for sign in (-1, 1)]

    def end(self, sign, limit):
        far = self.sd
        while self.ratio(self.mean + sign * far) < limit:
            far *= 2
            if far > 1e5 * self.sd:
                return sign * math.inf
        return optimize.brentq(lambda mean: self.ratio(mean) - limit, self.mean, self.mean + sign * far, xtol=1e-9)

    def p(self, null):
        t = math.sqrt((self.m - 1) * math.expm1(max(self.ratio(null), 0) / self.m))
        return 2 * stats.t.sf(t, self.m - 1)


# --- The program's printed estimates ---

TOLERANCE = 0.02  # of a likelihood's logarithm: where it is flat, an end may lie far off
MEAN_TOLERANCE_DB = 1e-4  # from the same thresholds


class Comparison:
    """The largest differences, and states that differ."""

    def __init__(self):
        self.n = self.at_border = 0
        self.largest, self.farthest = {}, {}
        self.other_states = []

    def add(self, name, theirs, ours):
        self.n += 1
        pairs = {what: (theirs[what], ours[what]) for what in theirs if what != "censored"}
        others = [f"{name}: {what} is {stated}, not {found}" for what, (stated, found) in pairs.items()
                  if stated != found and not (is_number(stated) and is_number(found))]
        if theirs["censored"] != ours["censored"]:
            others.append(f"{name} is '{theirs['censored']}', not '{ours['censored']}'")
        if others and ours["border"] < TOLERANCE:
            self.at_border += 1
            return
        self.other_states += others
        for what, (stated, found) in pairs.items():
            if is_number(stated) and is_number(found):
                log = ours["averages"].any if what in ("low", "high") else ours["averages"].typical
                apart = float(abs(log(stated) - log(found)))
                self.largest[what] = max(self.largest.get(what, (0.0, "")), (apart, name))
                self.farthest[what] = max(self.farthest.get(what, 0.0), abs(stated - found))

    def report(self, check, name):
        check(name, self.n > 0 and not self.other_states and all(d <= TOLERANCE for d, _ in self.largest.values()),
            f"{self.n} tracks, log-likelihoods apart at most: "
            + ", ".join(f"{what} {d:.1e} ({of}; {self.farthest[what]:.1e} dB)" for what, (d, of) in self.largest.items())
            + f"; {self.at_border} states within {TOLERANCE} of a border"
            + "".join("; " + text for text in self.other_states[:5]))


def is_number(x):
    return x is not None and math.isfinite(x)


def check_estimates(check, cases):
    comparison = Comparison()
    for i, case in enumerate(cases):
        comparison.add(f"track {i + 1}", case["estimate"],
                       estimate(case["counts"], case["levels"], case["guess"], case["shape"]))
    comparison.report(check, "estimates against Gauss-Legendre sums")


# --- The thresholds of an exported study ---

def number(text):
    return None if text in ("", None) else float(text)


def table(folder, name):
    with open(os.path.join(folder, name), encoding="utf-8-sig", newline="") as file:
        return list(csv.DictReader(file))


def stated_track(row):
    """In the form of `estimate`. Empty bounds are open."""
    at_least, at_most = number(row["at_least_db"]), number(row["at_most_db"])
    return {"level": number(row["threshold_db"]), "low": number(row["low_db"]), "high": number(row["high_db"]),
            "censored": row["censored"] or "no", "at_least": -math.inf if at_least is None else at_least,
            "at_most": math.inf if at_most is None else at_most}


class Task:
    """Levels and guess rate of the study file."""

    def __init__(self, study):
        self.section = study["threshold"]
        planes = {"odd-one-out": 3}.get(self.section.get("question"), 2)
        self.guess = 1 / self.section.get("intervals", planes)
        self.shape = self.section.get("grid", {}).get("shape", "weibull")
        levels = self.section["levels"]
        if isinstance(levels, dict):
            count = round((levels["to"] - levels["from"]) / levels["step"]) + 1
            levels = [levels["from"] + i * levels["step"] for i in range(count)]
        self.levels = levels

    def levels_of(self, standard):
        """The levels with possible comparisons: at most the ceiling, an order below 1, all of the second texture."""
        along = self.section.get("along", "gain")
        if self.section["task"] == "detection":
            return self.levels
        if along == "gain":
            return [x for x in self.levels if standard + 20 * math.log10(1 + 10 ** (x / 20)) <= 1e-9]
        if along == "order":
            return [x for x in self.levels if standard * (1 + 10 ** (x / 20)) < 1]
        return [x for x in self.levels if x <= 0] if along == "blend" else self.levels


def counts_of(folder):
    """Numbers of right answers and of all answers by level for each participant's tracks, including catch trials."""
    counts = {}
    for row in table(folder, "tracks.csv"):
        if row["kind"] == "control" or row["track"] in ("", "0") or row["correct"] == "":
            continue
        of_level = counts.setdefault((row["participant"], row["track"]), {}).setdefault(float(row["level_db"]), [0, 0])
        of_level[0] += int(row["correct"])
        of_level[1] += 1
    return {key: [(level, *pair) for level, pair in sorted(of.items())] for key, of in counts.items()}


def check_folder(check, folder, report):
    """Each threshold of thresholds.csv; with a report, the means over people of these."""
    with open(os.path.join(folder, "study_file.json"), encoding="utf-8") as file:
        task = Task(json.load(file))
    if task.section.get("question") == "same-different":
        return check("thresholds", True, "none: the task is 'same or different'")
    counts, comparison, people = counts_of(folder), Comparison(), {}
    for row in table(folder, "thresholds.csv"):
        standard = float(row["standard_value"])
        stated = stated_track(row)
        comparison.add(f"{row['participant']}, track {row['track']}", stated,
                       estimate(counts[row["participant"], row["track"]], task.levels_of(standard), task.guess, task.shape))
        people.setdefault((row["class"], standard), {}).setdefault(row["participant"], []).append(
            (stated["at_least"], stated["at_most"]))
    comparison.report(check, "thresholds of thresholds.csv")
    if report is not None:
        with open(report, encoding="utf-8") as file:
            for standard in json.load(file)["standards"]:
                check_mean(check, standard, people[standard["class"], standard["value"]].values())


def check_mean(check, standard, people):
    """Checks one of the report's standards; `people` are the bounds of each person's tracks."""
    name, stated = f"mean of {standard['standard']}", standard["mean"]
    bounds = [tuple(np.mean(tracks, axis=0)) for tracks in people]
    known = [low for low, high in bounds if low == high]
    if 2 * len(known) < len(bounds):
        return check(name, stated is None, "more than half are not known: no mean")
    if len(set(known)) < 2:
        return check(name, standard["interval"] is None, "fewer than two different thresholds: no interval")
    ours = CensoredNormal(bounds)
    interval = standard["interval"] or (None, None)
    pairs = [(stated, ours.mean), (standard["sd"], ours.sd * math.sqrt(ours.m / (ours.m - 1))),
             *((open_end if end is None else end, found)  # null in JSON
               for end, open_end, found in zip(interval, (-math.inf, math.inf), ours.interval()))]
    apart = max(0.0 if a == b else abs(a - b) for a, b in pairs)
    check(name, apart <= MEAN_TOLERANCE_DB,
        f"{len(known)} of {len(bounds)} known; mean, SD and interval within {apart:.1e} dB")


def main():
    parser = argparse.ArgumentParser(prog="crosscheck-procedures --thresholds")
    parser.add_argument("folder", help="a `csv` export of a study of thresholds")
    parser.add_argument("--report", help="output of `report --json`")
    options = parser.parse_args()
    failed = []

    def check(name, holds, text):
        print(f"{'ok  ' if holds else 'FAIL'}  {name}: {text}", flush=True)
        failed.extend([] if holds else [name])

    check_folder(check, options.folder, options.report)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
