"""Recomputes thresholds from counts of right answers, and their means over people, as defined in docs/thresholds.md.
Called by scripts/crosscheck-procedures. Does not use the program's quadrature.
"""

import argparse, csv, json, math, os, sys
import numpy as np
from scipy import interpolate, optimize, special, stats

# --- Definitions of docs/thresholds.md ---

WIDTH_RANGE = (2.0, 60.0)  # dB, from F = .05 to .95
TYPICAL_WIDTH = stats.lognorm(s=0.8, scale=10)
LAPSE_RANGE = (0.0, 0.5)
LAPSE_PRIOR = stats.beta(1, 3)
TYPICAL_LAPSE = stats.beta(1, 10)
EXTENSION_DB = 20.0  # dB by which thresholds are extended on either side, or the range of the levels
MAX_LOSS = stats.chi2.ppf(0.95, 1) / 2
WIDTH_AT_ONE = {"weibull": 20 * (math.log10(-math.log(0.05)) - math.log10(-math.log(0.95))),
                "logistic": 2 * math.log(19), "normal": 2 * stats.norm.isf(0.05)}


# --- One track ---

def rising_and_falling(shape, z):
    """F and 1 - F."""
    if shape == "weibull":
        power = 10 ** (np.minimum(z, 80) / 20)
        return -np.expm1(-power), np.exp(-power)
    if shape == "logistic":
        return special.expit(z), special.expit(-z)
    return special.ndtr(z), special.ndtr(-z)


def nodes(low, high, n):
    points, weights = np.polynomial.legendre.leggauss(n)
    return low + (points + 1) * (high - low) / 2, weights * (high - low) / 2


class Averages:
    """Log-likelihoods of thresholds, averaged over three kinds of observers, as splines."""

    def __init__(self, counts, levels, guess, shape, step=0.2, n=32):
        span = max(max(levels) - min(levels), EXTENSION_DB)
        low, high = min(levels) - span, max(levels) + span
        self.t = np.linspace(low, high, round((high - low) / step) + 1)
        log_width, width_weights = nodes(*np.log(WIDTH_RANGE), n)
        lapse, lapse_weights = nodes(*LAPSE_RANGE, n)
        width = np.exp(log_width)
        value = np.zeros((self.t.size, n, n))
        for level, right, answers in counts:
            rising, falling = rising_and_falling(shape, WIDTH_AT_ONE[shape] / width * (level - self.t[:, None]))
            rising, falling = rising[:, :, None], falling[:, :, None]
            if right > 0:
                value += right * np.log(guess + (1 - guess - lapse) * rising)
            if answers > right:
                value += (answers - right) * np.log((1 - guess) * falling + lapse * rising)
        top = value.max(axis=(1, 2))
        likelihood = np.exp(value - top[:, None, None])
        any_width_weights = width_weights * width * width ** 0.5  # the nodes are of the logarithm
        typical_lapse_weights = lapse_weights * TYPICAL_LAPSE.pdf(lapse)

        def average(widths, lapses):
            return interpolate.CubicSpline(self.t, top + np.log((likelihood @ lapses) @ widths))

        self.any = average(any_width_weights, lapse_weights * LAPSE_PRIOR.pdf(lapse))
        self.typical_lapses = average(any_width_weights, typical_lapse_weights)
        self.typical = average(width_weights * width * TYPICAL_WIDTH.pdf(width), typical_lapse_weights)

    def top(self, log):
        peaks = [x for x in log.derivative().roots(extrapolate=False) if np.isfinite(x)]
        return log([self.t[0], self.t[-1], *peaks]).max()

    def rise(self):
        """The smaller excess of log-likelihood loss over MAX_LOSS, for typical observers who feel all levels or none."""
        return self.top(self.typical) - MAX_LOSS - max(self.typical([self.t[0], self.t[-1]]))

    def interval(self, log):
        """The first and last threshold with a loss of at most MAX_LOSS; infinite at the end of the extended levels."""
        limit = self.top(log) - MAX_LOSS
        inside = np.flatnonzero(log(self.t) >= limit)
        first, last = inside[0], inside[-1]

        def crossing(i):
            return optimize.brentq(lambda t: log(t) - limit, self.t[i], self.t[i + 1], xtol=1e-10)

        return (-math.inf if first == 0 else crossing(first - 1),
                math.inf if last == self.t.size - 1 else crossing(last))

    def margin(self, number, first, last):
        """The smallest log-likelihood difference that decides a state."""
        limits = [(log, self.top(log) - MAX_LOSS) for log in (self.any, self.typical_lapses)]
        ends = [abs(log(x) - limit) for log, limit in limits for x in (first, last, self.t[0], self.t[-1])]
        numbers = [abs(self.typical(number) - self.typical(x)) for x in (first, last)]
        return min(abs(self.rise()), *ends, *numbers)

    def likeliest(self, low, high):
        """The most likely threshold between two limits, for typical observers."""
        low, high = max(low, self.t[0]), min(high, self.t[-1])
        peaks = self.typical.derivative().roots(extrapolate=False)
        return max([low, high, *peaks[(peaks > low) & (peaks < high)]], key=self.typical)


def estimate(counts, levels, guess, shape):
    """A track's threshold and interval, or on which side of the levels it is; its bounds for means; the likelihoods; and
    the smallest log-likelihood difference that decides between two states."""
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
            "margin": averages.margin(number, first, last)}


# --- Means over people ---

class CensoredNormal:
    """Likelihood of a mean and an SD, given each person's bounds; equal bounds are known values."""

    def __init__(self, bounds):
        bounds = np.asarray(bounds, float)
        exact = bounds[:, 0] == bounds[:, 1]
        self.exact, self.censored, self.known_count = bounds[exact, 0], bounds[~exact], exact.sum()
        start = self.exact.mean(), math.log(max(self.exact.std(), 0.1))
        # From several starts, because tails can create a second maximum.
        fits = [optimize.minimize(lambda x: -self.log_likelihood(*x), (start[0] + shift, start[1] + growth),
                                  method="Nelder-Mead",
                                  options={"xatol": 1e-10, "fatol": 1e-13, "maxiter": 4000, "maxfev": 4000})
                for shift, growth in ((0, 0), (0, 0.7), (math.exp(start[1]), 0.3), (-math.exp(start[1]), 0.3))]
        best = min(fits, key=lambda fit: fit.fun)
        self.mean, self.sd, self.max_log = best.x[0], math.exp(best.x[1]), -best.fun

    def log_likelihood(self, mean, log_sd):
        sd = math.exp(log_sd)
        value = -len(self.exact) * log_sd - ((self.exact - mean) ** 2).sum() / (2 * sd * sd)
        low, high = (self.censored - mean).T / sd
        mirrored = low > 0  # the lower tail keeps full precision
        a, b = special.log_ndtr(np.where(mirrored, -high, low)), special.log_ndtr(np.where(mirrored, -low, high))
        return value + (b + np.log(-np.expm1(np.minimum(a - b, -1e-300)))).sum()

    def ratio(self, mean):
        """Twice the loss of log likelihood of the best SD for this mean."""
        middle = math.log(math.hypot(self.sd, mean - self.mean))
        best = optimize.minimize_scalar(lambda log_sd: -self.log_likelihood(mean, log_sd),
                                        bounds=(middle - 3, middle + 3), method="bounded", options={"xatol": 1e-10})
        return 2 * (self.max_log + best.fun)

    def interval(self):
        """The means at which the ratio equals that of Student's interval of the known values."""
        limit = self.known_count * math.log1p(stats.t.ppf(0.975, self.known_count - 1) ** 2 / (self.known_count - 1))
        return [self.end(sign, limit) for sign in (-1, 1)]

    def end(self, sign, limit):
        distance = self.sd
        while self.ratio(self.mean + sign * distance) < limit:
            distance *= 2
            if distance > 1e5 * self.sd:
                return sign * math.inf
        return optimize.brentq(lambda mean: self.ratio(mean) - limit, self.mean, self.mean + sign * distance, xtol=1e-9)

    def p(self, null):
        t = math.sqrt((self.known_count - 1) * math.expm1(max(self.ratio(null), 0) / self.known_count))
        return 2 * stats.t.sf(t, self.known_count - 1)


# --- The program's printed estimates ---

TOLERANCE = 0.02  # of log-likelihoods, because ends are uncertain where the likelihood is flat
MEAN_TOLERANCE_DB = 1e-4  # given the same thresholds


class Comparison:
    """The largest differences, and states that differ."""

    def __init__(self):
        self.n = self.undecided = 0
        self.largest, self.largest_db = {}, {}
        self.other_states = []

    def add(self, name, theirs, ours):
        self.n += 1
        pairs = {key: (theirs[key], ours[key]) for key in theirs if key != "censored"}
        differences = [f"{name}: {key} is {reported}, not {expected}" for key, (reported, expected) in pairs.items()
                       if reported != expected and not (is_number(reported) and is_number(expected))]
        if theirs["censored"] != ours["censored"]:
            differences.append(f"{name} is '{theirs['censored']}', not '{ours['censored']}'")
        if differences and ours["margin"] < TOLERANCE:
            self.undecided += 1
            return
        self.other_states += differences
        for key, (reported, expected) in pairs.items():
            if is_number(reported) and is_number(expected):
                log = ours["averages"].any if key in ("low", "high") else ours["averages"].typical
                difference = float(abs(log(reported) - log(expected)))
                self.largest[key] = max(self.largest.get(key, (0.0, "")), (difference, name))
                self.largest_db[key] = max(self.largest_db.get(key, 0.0), abs(reported - expected))

    def report(self, check, name):
        check(name, self.n > 0 and not self.other_states and all(d <= TOLERANCE for d, _ in self.largest.values()),
            f"{self.n} tracks, log-likelihoods differ at most: "
            + ", ".join(f"{key} {d:.1e} ({track}; {self.largest_db[key]:.1e} dB)"
                        for key, (d, track) in self.largest.items())
            + f"; {self.undecided} states decided by less than {TOLERANCE}"
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
    """A row in the format of `estimate`; empty bounds are infinite."""
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
        """The levels whose comparison exists: at most the full gain, an order below 1, or all of the second texture."""
        quantity = self.section.get("along", "gain")
        if self.section["task"] == "detection":
            return self.levels
        if quantity == "gain":
            return [x for x in self.levels if standard + 20 * math.log10(1 + 10 ** (x / 20)) <= 1e-9]
        if quantity == "order":
            return [x for x in self.levels if standard * (1 + 10 ** (x / 20)) < 1]
        return [x for x in self.levels if x <= 0] if quantity == "blend" else self.levels


def counts_of(folder):
    """Numbers of right answers and of all answers by level for each participant's tracks, including catch trials."""
    counts = {}
    for row in table(folder, "tracks.csv"):
        if row["kind"] == "control" or row["track"] in ("", "0") or row["correct"] == "":
            continue
        at_level = counts.setdefault((row["participant"], row["track"]), {}).setdefault(float(row["level_db"]), [0, 0])
        at_level[0] += int(row["correct"])
        at_level[1] += 1
    return {key: [(level, *pair) for level, pair in sorted(levels.items())] for key, levels in counts.items()}


def check_folder(check, folder, report):
    """Checks each threshold of thresholds.csv and, with a report, their means over people."""
    with open(os.path.join(folder, "study_file.json"), encoding="utf-8") as file:
        task = Task(json.load(file))
    if task.section.get("question") == "same-different":
        return check("thresholds", True, "none: the task is 'same or different'")
    counts, comparison, people = counts_of(folder), Comparison(), {}
    for row in table(folder, "thresholds.csv"):
        standard = float(row["standard_value"])
        reported = stated_track(row)
        comparison.add(f"{row['participant']}, track {row['track']}", reported,
                       estimate(counts[row["participant"], row["track"]], task.levels_of(standard), task.guess, task.shape))
        people.setdefault((row["class"], standard), {}).setdefault(row["participant"], []).append(
            (reported["at_least"], reported["at_most"]))
    comparison.report(check, "thresholds of thresholds.csv")
    if report is not None:
        with open(report, encoding="utf-8") as file:
            for standard in json.load(file)["standards"]:
                check_mean(check, standard, people[standard["class"], standard["value"]].values())


def check_mean(check, standard, people):
    """Checks one of the report's standards; `people` are the bounds of each person's tracks."""
    name, reported = f"mean of {standard['standard']}", standard["mean"]
    bounds = [tuple(np.mean(tracks, axis=0)) for tracks in people]
    exact = [low for low, high in bounds if low == high]
    if 2 * len(exact) < len(bounds):
        return check(name, reported is None, "more than half are unknown: no mean")
    if len(set(exact)) < 2:
        return check(name, standard["interval"] is None, "fewer than two different thresholds: no interval")
    ours = CensoredNormal(bounds)
    interval = standard["interval"] or (None, None)
    pairs = [(reported, ours.mean), (standard["sd"], ours.sd * math.sqrt(ours.known_count / (ours.known_count - 1))),
             *((open_end if end is None else end, expected)  # null in JSON
               for end, open_end, expected in zip(interval, (-math.inf, math.inf), ours.interval()))]
    difference = max(0.0 if a == b else abs(a - b) for a, b in pairs)
    check(name, difference <= MEAN_TOLERANCE_DB,
        f"{len(exact)} of {len(bounds)} known; mean, SD and interval within {difference:.1e} dB")


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
