import csv
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

stem = pathlib.Path(__file__).with_suffix("")
with open(f"{stem}.csv", newline="", encoding="utf-8") as file:
    table = list(csv.DictReader(file))


def rows(layer):
    return [row for row in table if row["layer"] == str(layer)]


def column(layer, name):
    return [float(row[name] or "nan") for row in rows(layer)]


def lines(ax, layer, **look):  # a line for each text
    for text in dict.fromkeys(row["text"] for row in rows(layer)):
        own = [row for row in rows(layer) if row["text"] == text]
        ax.plot(*([float(row[name] or "nan") for row in own] for name in "xy"), **look)
        look.pop("label", None)


def texts(ax, layer, **look):
    for row in rows(layer):
        ax.text(float(row["x"]), float(row["y"]), row["text"], **look)


def rules(ax, layer, color, beyond=False, **look):  # lines through the panel, bands and names
    for row in rows(layer):
        level = row["y"] != ""
        if row["low"]:
            span = ax.axhspan if level else ax.axvspan
            span(float(row["low"]), float(row["high"]), color=color, alpha=0.16, linewidth=0)
        if level:
            ax.axhline(float(row["y"]), color=color, **look)
            ax.text(1.02 if beyond else 1, float(row["y"]), row["text"], color=color,
                    ha="left" if beyond else "right", va="center" if beyond else "bottom",
                    transform=ax.get_yaxis_transform())
        elif row["x"]:
            ax.axvline(float(row["x"]), color=color, **look)


plt.rcParams.update({"font.size": 8, "text.parse_math": False, "axes.linewidth": 0.6,
                     "axes.spines.top": False, "axes.spines.right": False})
