"""The reference ride inside the FMU: what every importer is given, and what it has to answer."""

import copy
import csv
import io
import zipfile
from xml.etree import ElementTree

LAYERED_STANDARD = "extra/org.fmi-standard.fmi-ls-ref"
# The reference has ten decimals, and importers compute the time of a step each in their own way.
EXACT = 1e-9
# Of the washout, whose plan's active limits depend on the last digits of the inputs.
TOLERANCE = 1e-3


class Ride:
    """The inputs and outputs of the ride, and the FMU's variables by name."""

    def __init__(self, fmu):
        with zipfile.ZipFile(fmu) as archive:
            description = ElementTree.fromstring(archive.read("modelDescription.xml"))
            self.fmi = description.get("fmiVersion")
            # By which the library knows the description: its GUID or, in FMI 3.0, its instantiation token.
            self.guid = description.get("guid") or description.get("instantiationToken")
            self.model = description.get("modelName")
            self.references = {v.get("name"): int(v.get("valueReference")) for v in description.find("ModelVariables")}
            experiment = ElementTree.fromstring(archive.read(f"{LAYERED_STANDARD}/{self.model}.exp")).find("Experiment")
            self.input_text = archive.read(f"{LAYERED_STANDARD}/{self.model}_in.csv").decode()
            output_text = archive.read(f"{LAYERED_STANDARD}/{self.model}_ref.csv").decode()
        self.step = float(experiment.get("stepSize"))
        self.stop = float(experiment.get("stopTime"))
        self.steps = round(self.stop / self.step)
        self.inputs, self.breakpoints = table(self.input_text)
        self.outputs, rows = table(output_text)
        # Which communication points the reference has, and its outputs there.
        self.expected = {round(time / self.step): values for time, *values in rows}

    def of_first_outputs(self, count):
        """The ride with this many outputs at most."""
        ride = copy.copy(self)
        ride.outputs = self.outputs[:count]
        ride.expected = {k: values[:count] for k, values in self.expected.items()}
        return ride

    def time(self, k):
        """The communication point before step k [s]."""
        return k * self.step

    def input(self, k):
        """The inputs during step k."""
        time = self.time(k)
        after = next((n for n, row in enumerate(self.breakpoints) if n > 0 and row[0] >= time), len(self.breakpoints) - 1)
        (t0, *before), (t1, *then) = self.breakpoints[after - 1 : after + 1]
        share = (time - t0) / (t1 - t0)
        return [a + share * (b - a) for a, b in zip(before, then)]

    def for_host(self, settings):
        """The ride as tests/platforms/host.c reads it, with these items of enumerations."""
        chosen = [number for name, item in settings.items() for number in (self.references[name], item)]
        inputs, outputs = ([self.references[name] for name in names] for names in (self.inputs, self.outputs))
        lines = [(len(settings), *chosen), (len(inputs), *inputs), (len(outputs), *outputs), (self.step, self.steps)]
        lines += [self.input(k) for k in range(self.steps)]
        return "".join(" ".join(map(repr, line)) + "\n" for line in lines)

    def replay(self, set_inputs, step, get_outputs):
        """Makes the ride with these functions; returns the largest difference from the reference."""
        answers = {}
        for k in range(self.steps):
            set_inputs(self.input(k))
            step(k)
            if k + 1 in self.expected:
                answers[k + 1] = get_outputs()
        return self.difference(answers)

    def difference(self, answers, last=None):
        """The largest difference of outputs, a list at each communication point, from the reference.

        The start may be missing; of the rest, everything has to be there up to the communication point `last`.
        """
        wanted = [k for k in self.expected if 0 < k <= (last or self.steps)]
        missing = [self.time(k) for k in wanted if k not in answers]
        assert not missing, f"there is no answer at {missing[:5]} s"
        compared = [k for k in (0, *wanted) if k in answers]
        return max(abs(a - b) for k in compared for a, b in zip(answers[k], self.expected[k], strict=True))

    def difference_of_table(self, text):
        """The same for the text of a comma-separated file of which the first column is the time."""
        names, rows = table(text)
        columns = [names.index(name) + 1 for name in self.outputs]
        answers = {}
        for row in rows:
            k = round(row[0] / self.step)
            if abs(row[0] - self.time(k)) < 1e-6 * self.step:
                answers[k] = [row[column] for column in columns]
        return self.difference(answers)


def table(text):
    """The names of all columns but the first, and the rows as numbers."""
    header, *rows = csv.reader(io.StringIO(text))
    return [name.strip() for name in header[1:]], [[number(cell) for cell in row] for row in rows]


def number(cell):
    truth = {"true": 1.0, "false": 0.0}
    return truth[cell.strip().lower()] if cell.strip().lower() in truth else float(cell)
