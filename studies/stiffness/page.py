"""The text of report.html: one self-contained page."""

CAPTIONS = {
    "pulse": """\
Normal force, friction force and slip velocity of the contact through the first pulse, from soft (dark) to
stiff (light), over the rigid hoop (black, wide). Time counts from the instant at which the disk is lowest.""",
    "impulses": """\
The same pulse in impulse space. A curve that runs along a dashed line slides; one that leaves it sticks; one
that turns toward the other line has reversed its slip. The slope from the origin to the end is the impulse
ratio.""",
    "distance": """\
How far the flexible hoop's measures are from the rigid ones. Triangles are the numerical error, known
from a second run at half the tolerance; the dashed line has the fitted rate and
spans the cases it was fitted to; the black one is predicted from the rigid motion, without any of them, and
begins where it holds.""",
    "energy": """\
Where the energy is and where it goes; below, the small terms on a logarithmic axis.""",
}
"""What stands under each figure."""

PAGE = """\
<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{{ title }}</title>
<style>
{{ style }}</style>
</head>
<body>
<h1>{{ title }}</h1>
<p class="lead">{{ verdict }}</p>

<h2>The limit of the first pulse</h2>
<div class="wide"><table><thead><tr>{% for cell in limit_heading %}<th>{{ cell }}</th>{% endfor
%}</tr></thead><tbody>
{% for row in limits %}<tr>{% for cell in row %}<td>{{ cell }}</td>{% endfor %}</tr>
{% endfor %}</tbody></table></div>
<p>{{ extrapolation }} The rate is that of the distance to the rigid value, the last distance that of the stiffest case.
{{ prediction }} {{ law }} {{ damping }}</p>

{% for name, caption, image in figures %}
<figure id="{{ name }}"><img alt="{{ caption }}" src="data:image/png;base64,{{ image }}"><figcaption>{{
caption }}</figcaption></figure>
{% endfor %}

<h2>Case by case</h2>
<div class="wide"><table><thead><tr>{% for cell in heading %}<th>{{ cell }}</th>{% endfor
%}</tr></thead><tbody>
{% for row in cases %}<tr>{% for cell in row.cells %}<td>{{ cell }}</td>{% endfor %}
{% if row.failure %}<td class="bad" colspan="{{ heading|length - 2 }}">{{ row.failure }}</td>{% endif %}</tr>
{% endfor %}<tr class="rigid">{% for cell in rigid %}<td>{{ cell }}</td>{% endfor %}</tr>
</tbody></table></div>
<p>± is the numerical error of a case, known from a second run at half the tolerance, that of the loss no less than
what the steps themselves took of the energy; the tolerance was tightened until that error was a tenth of the distance
to the rigid value, or of the predicted one where that is more, as far as the solver's own noise and a bound on its work
let it.{{ unresolved }}</p>

<h2>All measures of the first pulse, side by side</h2>
<div class="wide"><table><thead><tr>{% for cell in side_heading %}<th>{{ cell }}</th>{% endfor
%}</tr></thead><tbody>
{% for row in side %}<tr>{% for cell in row %}<td>{{ cell }}</td>{% endfor %}</tr>
{% endfor %}</tbody></table></div>

<h2>The scene</h2>
<pre>{{ scene }}</pre>
<h2>How this page was made</h2>
<pre>{{ command }}</pre>
<footer>{{ versions }}</footer>
</body>
</html>
"""
