<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="de" sourcelanguage="en">
 <context>
  <name>RegolithStudio</name>
  <message>
   <location filename="ui/actions.py" />
   <source>&amp;About Regolith Studio</source>
   <translation>&amp;Über Regolith Studio</translation>
  </message>
  <message>
   <location filename="ui/pages/lecture/__init__.py" />
   <source>&amp;Another one</source>
   <translation>&amp;Ein anderes</translation>
  </message>
  <message>
   <location filename="ui/pages/model/__init__.py" />
   <source>&amp;Another particle in the view</source>
   <translation>&amp;Ein anderes Partikel zeigen</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/__init__.py" />
   <source>&amp;Bounding box</source>
   <translation>&amp;Hüllquader</translation>
  </message>
  <message>
   <location filename="ui/pages/dataset/__init__.py" />
   <source>&amp;Build the dataset …</source>
   <translation>Datensatz &amp;bauen …</translation>
  </message>
  <message>
   <location filename="ui/pages/dataset/__init__.py" />
   <source>&amp;Check the dataset</source>
   <translation>Datensatz &amp;prüfen</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>&amp;Commands …</source>
   <translation>&amp;Befehle …</translation>
  </message>
  <message>
   <location filename="ui/pages/studies/__init__.py" />
   <source>&amp;Compute all</source>
   <translation>Alles &amp;berechnen</translation>
  </message>
  <message>
   <location filename="ui/pages/sample/__init__.py" />
   <source>&amp;Copy table</source>
   <translation>Tabelle k&amp;opieren</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>&amp;Dark</source>
   <translation>&amp;Dunkel</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/__init__.py" />
   <source>&amp;Distance map</source>
   <translation>&amp;Abstandskarte</translation>
  </message>
  <message>
   <location filename="ui/pages/model/__init__.py" />
   <source>&amp;Draw particles</source>
   <translation>Partikel &amp;ziehen</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>&amp;Edit</source>
   <translation>&amp;Bearbeiten</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/__init__.py" />
   <source>&amp;Enlarge one view</source>
   <translation>Eine Ansicht &amp;vergrößern</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>&amp;Export dataset …</source>
   <translation>Datensatz &amp;exportieren …</translation>
  </message>
  <message>
   <location filename="ui/pages/repose/__init__.py" />
   <source>&amp;Export figure and JSON …</source>
   <translation>Abbildung und JSON &amp;exportieren …</translation>
  </message>
  <message>
   <location filename="ui/pages/dataset/__init__.py" />
   <source>&amp;Export to DEM programs …</source>
   <translation>In DEM-Programme &amp;exportieren …</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>&amp;File</source>
   <translation>&amp;Datei</translation>
  </message>
  <message>
   <location filename="ui/pages/scan/__init__.py" />
   <source>&amp;Find grains</source>
   <translation>Körner &amp;finden</translation>
  </message>
  <message>
   <location filename="ui/pages/dataset/__init__.py" />
   <source>&amp;Find representatives</source>
   <translation>&amp;Repräsentanten finden</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>&amp;Go</source>
   <translation>&amp;Gehe zu</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>&amp;Help</source>
   <translation>&amp;Hilfe</translation>
  </message>
  <message>
   <location filename="ui/pages/model/__init__.py" />
   <source>&amp;Judge models</source>
   <translation>Modelle &amp;beurteilen</translation>
  </message>
  <message>
   <location filename="ui/pages/sample/__init__.py" />
   <source>&amp;Keep only these</source>
   <translation>Nur diese &amp;behalten</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>&amp;Keyboard and mouse</source>
   <translation>&amp;Tastatur und Maus</translation>
  </message>
  <message>
   <location filename="ui/pages/lecture/__init__.py" />
   <source>&amp;Larger letters</source>
   <translation>&amp;Größere Schrift</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>&amp;Light</source>
   <translation>&amp;Hell</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/__init__.py" />
   <source>&amp;Link cameras</source>
   <translation>&amp;Kameras koppeln</translation>
  </message>
  <message>
   <location filename="ui/pages/scan/__init__.py" />
   <source>&amp;Make particles</source>
   <translation>&amp;Partikel erzeugen</translation>
  </message>
  <message>
   <location filename="ui/pages/repose/__init__.py" />
   <source>&amp;Measure positions …</source>
   <translation>Positionen &amp;vermessen …</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>&amp;Next page</source>
   <translation>&amp;Nächste Seite</translation>
  </message>
  <message>
   <location filename="ui/pages/dataset/__init__.py" />
   <source>&amp;Open a dataset …</source>
   <translation>Datensatz &amp;öffnen …</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>&amp;Open …</source>
   <translation>Ö&amp;ffnen …</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/__init__.py" />
   <source>&amp;Overlay</source>
   <translation>Überla&amp;gern</translation>
  </message>
  <message>
   <location filename="ui/action_spec.py" />
   <source>&amp;Page</source>
   <translation>&amp;Seite</translation>
  </message>
  <message>
   <location filename="ui/pages/lecture/__init__.py" />
   <source>&amp;Play or pause</source>
   <translation>&amp;Abspielen oder anhalten</translation>
  </message>
  <message>
   <location filename="ui/pages/repose/__init__.py" />
   <source>&amp;Play the run</source>
   <translation>Lauf &amp;abspielen</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>&amp;Previous page</source>
   <translation>&amp;Vorherige Seite</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>&amp;Quit</source>
   <translation>&amp;Beenden</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>&amp;Redo</source>
   <translation>&amp;Wiederholen</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/__init__.py" />
   <source>&amp;Reset cameras</source>
   <translation>Kameras &amp;zurücksetzen</translation>
  </message>
  <message>
   <location filename="ui/pages/repose/__init__.py" />
   <source>&amp;Run the test</source>
   <translation>Versuch durch&amp;führen</translation>
  </message>
  <message>
   <location filename="ui/pages/studies/__init__.py" />
   <source>&amp;Save figures and tables …</source>
   <translation>Abbildungen und Tabellen &amp;speichern …</translation>
  </message>
  <message>
   <location filename="ui/pages/model/__init__.py" />
   <source>&amp;Save model …</source>
   <translation>Modell &amp;speichern …</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>&amp;Save project</source>
   <translation>Projekt &amp;speichern</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>&amp;Tasks</source>
   <translation>A&amp;ufgaben</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>&amp;Theme</source>
   <translation>&amp;Farbschema</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>&amp;Tour</source>
   <translation>&amp;Rundgang</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>&amp;Undo</source>
   <translation>&amp;Rückgängig</translation>
  </message>
  <message>
   <location filename="ui/pages/model/__init__.py" />
   <source>&amp;Use as population</source>
   <translation>Als Population &amp;verwenden</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <location filename="ui/pages/explore/__init__.py" />
   <source>&amp;View</source>
   <translation>&amp;Ansicht</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/__init__.py" />
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
   <location filename="ui/dialogs/help.py" />
   <source>(not installed)</source>
   <translation>(nicht installiert)</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch.py" />
   <source>1 worker</source>
   <translation>1 Arbeitsprozess</translation>
  </message>
  <message>
   <location filename="ui/views/triptych.py" />
   <source>; {count} facets were asked for</source>
   <translation>; {count} Facetten waren verlangt</translation>
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
   <location filename="ui/dialogs/batch_fields.py" />
   <source>A Dask cluster at an address</source>
   <translation>Ein Dask-Cluster an einer Adresse</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch_fields.py" />
   <source>A Dask cluster started on this machine</source>
   <translation>Ein auf diesem Rechner gestarteter Dask-Cluster</translation>
  </message>
  <message>
   <source>A closed mesh without faults.</source>
   <translation>Ein geschlossenes, fehlerfreies Netz.</translation>
  </message>
  <message>
   <location filename="ui/activity.py" />
   <source>A dataset was written to {folder}.</source>
   <translation>Ein Datensatz wurde nach {folder} geschrieben.</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/pictures.py" />
   <source>A figure on white, 1860 × 560 times the scale</source>
   <translation>Eine Abbildung auf Weiß, 1860 × 560 mal der Maßstab</translation>
  </message>
  <message>
   <source>A of the hull / A of its ellipsoid (after Kuo and Freeman)</source>
   <translation>A der Hülle / A ihres Ellipsoids (nach Kuo und Freeman)</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch_fields.py" />
   <source>A recipe file</source>
   <translation>Eine Rezeptdatei</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>A script that does the same</source>
   <translation>Ein Skript, das dasselbe tut</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>A walk through the window</source>
   <translation>Ein Gang durch das Fenster</translation>
  </message>
  <message>
   <location filename="ui/dialogs/help.py" />
   <source>About Regolith Studio</source>
   <translation>Über Regolith Studio</translation>
  </message>
  <message>
   <location filename="ui/activity.py" />
   <source>Activity</source>
   <translation>Vorgänge</translation>
  </message>
  <message>
   <source>Adaptive step</source>
   <translation>Angepasste Schrittweite</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch_fields.py" />
   <source>Address of the scheduler</source>
   <translation>Adresse des Schedulers</translation>
  </message>
  <message>
   <source>All descriptors</source>
   <translation>Alle Deskriptoren</translation>
  </message>
  <message>
   <source>All descriptors and overlap</source>
   <translation>Alle Deskriptoren und Überdeckung</translation>
  </message>
  <message>
   <source>All descriptors of all particles: sort, filter with words such as flat S&lt;0.8, choose several rows, and see them in the scatter plot. Export the table with units.</source>
   <translation>Alle Deskriptoren aller Partikel: sortieren, mit Wörtern wie flat S&lt;0.8 filtern, mehrere Zeilen wählen und sie im Streudiagramm sehen. Die Tabelle lässt sich mit Einheiten exportieren.</translation>
  </message>
  <message>
   <location filename="ui/commands.py" />
   <source>All files (*)</source>
   <translation>Alle Dateien (*)</translation>
  </message>
  <message>
   <location filename="ui/pages/sample/__init__.py" />
   <source>All particles: table, scatter plot, health and statistics of groups</source>
   <translation>Alle Partikel: Tabelle, Streudiagramm, Zustand der Netze und Statistik der Gruppen</translation>
  </message>
  <message>
   <location filename="ui/dialogs/shortcuts.py" />
   <source>All usual keys</source>
   <translation>Alle üblichen Tasten</translation>
  </message>
  <message>
   <location filename="ui/dialogs/export.py" />
   <source>Also</source>
   <translation>Außerdem</translation>
  </message>
  <message>
   <location filename="ui/panels/spectrum.py" />
   <source>Amplitude √A&lt;sub&gt;l&lt;/sub&gt; / c&lt;sub&gt;00&lt;/sub&gt; [%]</source>
   <translation>Amplitude √A&lt;sub&gt;l&lt;/sub&gt; / c&lt;sub&gt;00&lt;/sub&gt; [%]</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch_fields.py" />
   <source>An encrypted cluster needs a folder with {names}.</source>
   <translation>Ein verschlüsselter Cluster braucht einen Ordner mit {names}.</translation>
  </message>
  <message>
   <location filename="ui/pages/lecture/__init__.py" />
   <source>And back</source>
   <translation>Und zurück</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/__init__.py" />
   <source>And what it cannot see</source>
   <translation>Und was er nicht sieht</translation>
  </message>
  <message>
   <location filename="ui/pages/repose/__init__.py" />
   <source>Angle of repose</source>
   <translation>Schüttwinkel</translation>
  </message>
  <message>
   <source>Angularity</source>
   <translation>Kantigkeit</translation>
  </message>
  <message>
   <location filename="ui/pages/lecture/__init__.py" />
   <source>Annealing step by step, l_max growing, a random field on the sphere; large letters</source>
   <translation>Simuliertes Abkühlen Schritt für Schritt, wachsendes l_max, ein Zufallsfeld auf der Kugel; in großer Schrift</translation>
  </message>
  <message>
   <location filename="ui/pages/lecture/__init__.py" />
   <source>Another seed</source>
   <translation>Anderer Startwert</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>Any command by a few letters</source>
   <translation>Jeder Befehl nach wenigen Buchstaben</translation>
  </message>
  <message>
   <location filename="ui/pages/sample/__init__.py" />
   <source>As a CSV file</source>
   <translation>Als CSV-Datei</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>As the &amp;system</source>
   <translation>Wie das &amp;System</translation>
  </message>
  <message>
   <location filename="ui/dialogs/preferences.py" />
   <location filename="ui/translation/language.py" />
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
   <location filename="ui/panels/particle_list.py" />
   <source>Aspect ratio, Eq. 2</source>
   <translation>Seitenverhältnis, Gl. 2</translation>
  </message>
  <message>
   <location filename="ui/panels/fit.py" />
   <source>Automatic</source>
   <translation>Automatisch</translation>
  </message>
  <message>
   <location filename="ui/tour.py" />
   <source>Back</source>
   <translation>Zurück</translation>
  </message>
  <message>
   <source>Back (from +y)</source>
   <translation>Hinten (von +y)</translation>
  </message>
  <message>
   <location filename="ui/widgets/preset_bar.py" />
   <source>Back to the values of the preset</source>
   <translation>Zurück zu den Werten der Vorlage</translation>
  </message>
  <message>
   <source>Being measured …</source>
   <translation>Wird vermessen …</translation>
  </message>
  <message>
   <location filename="ui/panels/fit.py" />
   <source>Best-fit ellipsoid</source>
   <translation>Angepasstes Ellipsoid</translation>
  </message>
  <message>
   <source>Bottom (from -z)</source>
   <translation>Unten (von -z)</translation>
  </message>
  <message>
   <location filename="session/session.py" />
   <source>Bringing particles back</source>
   <translation>Partikel werden zurückgeholt</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch_fields.py" />
   <location filename="ui/dialogs/export.py" />
   <source>Browse …</source>
   <translation>Durchsuchen …</translation>
  </message>
  <message>
   <location filename="session/session.py" />
   <source>Building the dataset</source>
   <translation>Datensatz wird gebaut</translation>
  </message>
  <message>
   <location filename="ui/pages/studies/__init__.py" />
   <source>CSV, JSON, PNG, SVG</source>
   <translation>CSV, JSON, PNG, SVG</translation>
  </message>
  <message>
   <location filename="ui/panels/coarsening.py" />
   <location filename="ui/views/triptych.py" />
   <source>CT particle</source>
   <translation>CT-Partikel</translation>
  </message>
  <message>
   <location filename="ui/views/triptych.py" />
   <source>CT particle, {name}</source>
   <translation>CT-Partikel, {name}</translation>
  </message>
  <message>
   <location filename="ui/dialogs/unit.py" />
   <source>Centimetres (cm)</source>
   <translation>Zentimeter (cm)</translation>
  </message>
  <message>
   <location filename="ui/panels/fit.py" />
   <source>Centre of mass</source>
   <translation>Schwerpunkt</translation>
  </message>
  <message>
   <location filename="ui/panels/fit.py" />
   <source>Centre of the kernel</source>
   <translation>Mitte des Kerns</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch_fields.py" />
   <source>Certificates</source>
   <translation>Zertifikate</translation>
  </message>
  <message>
   <location filename="ui/dialogs/shortcuts.py" />
   <source>Change</source>
   <translation>Ändern</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch_fields.py" />
   <source>Choose a recipe file.</source>
   <translation>Wählen Sie eine Rezeptdatei.</translation>
  </message>
  <message>
   <location filename="ui/pages/dataset/__init__.py" />
   <source>Choose representative particles, build a dataset, export it to DEM programs</source>
   <translation>Repräsentative Partikel wählen, einen Datensatz bauen, in DEM-Programme exportieren</translation>
  </message>
  <message>
   <location filename="ui/pages/repose/__init__.py" />
   <source>Choose the dataset to simulate</source>
   <translation>Den Datensatz der Simulation wählen</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch.py" />
   <source>Choose what is to be written.</source>
   <translation>Wählen Sie, was geschrieben werden soll.</translation>
  </message>
  <message>
   <location filename="ui/pages/sample/__init__.py" />
   <source>Clear &amp;filter</source>
   <translation>&amp;Filter leeren</translation>
  </message>
  <message>
   <location filename="ui/dialogs/closing.py" />
   <source>Close Regolith Studio?</source>
   <translation>Regolith Studio schließen?</translation>
  </message>
  <message>
   <location filename="ui/pages/sample/__init__.py" />
   <source>Close all particles but the chosen rows</source>
   <translation>Alle Partikel außer den gewählten Zeilen schließen</translation>
  </message>
  <message>
   <location filename="ui/widgets/toast.py" />
   <source>Close this message</source>
   <translation>Diese Meldung schließen</translation>
  </message>
  <message>
   <location filename="ui/dialogs/closing.py" />
   <source>Closing the window stops it.</source>
   <translation>Das Schließen des Fensters bricht das ab.</translation>
  </message>
  <message>
   <location filename="ui/panels/coarsening.py" />
   <source>Coarsened polyhedron</source>
   <translation>Vergröbertes Polyeder</translation>
  </message>
  <message>
   <location filename="jobs/coarsening.py" />
   <source>Coarsening</source>
   <translation>Vergröberung</translation>
  </message>
  <message>
   <location filename="session/solids.py" />
   <source>Coarsening for the gallery</source>
   <translation>Vergröberung für die Galerie</translation>
  </message>
  <message>
   <location filename="ui/panels/coarsening.py" />
   <source>Coarsening method</source>
   <translation>Verfahren der Vergröberung</translation>
  </message>
  <message>
   <location filename="ui/dialogs/command_palette.py" />
   <location filename="ui/dialogs/shortcuts.py" />
   <source>Command</source>
   <translation>Befehl</translation>
  </message>
  <message>
   <location filename="ui/dialogs/command_palette.py" />
   <source>Commands</source>
   <translation>Befehle</translation>
  </message>
  <message>
   <location filename="ui/dialogs/shortcuts.py" />
   <source>Commands and their keys</source>
   <translation>Befehle und ihre Tasten</translation>
  </message>
  <message>
   <location filename="ui/dialogs/command_palette.py" />
   <source>Commands that fit</source>
   <translation>Passende Befehle</translation>
  </message>
  <message>
   <location filename="ui/views/comparison.py" />
   <source>Compare the fit with</source>
   <translation>Den Fit vergleichen mit</translation>
  </message>
  <message>
   <location filename="ui/views/comparison.py" />
   <source>Compare the particle with</source>
   <translation>Das Partikel vergleichen mit</translation>
  </message>
  <message>
   <location filename="ui/views/comparison.py" />
   <source>Compare the polyhedron with</source>
   <translation>Das Polyeder vergleichen mit</translation>
  </message>
  <message>
   <source>Compiling</source>
   <translation>Übersetzen des Programms</translation>
  </message>
  <message>
   <location filename="ui/widgets/study_frame.py" />
   <source>Compute</source>
   <translation>Berechnen</translation>
  </message>
  <message>
   <location filename="ui/widgets/study_frame.py" />
   <source>Compute for all {count} particles</source>
   <translation>Für alle {count} Partikel berechnen</translation>
  </message>
  <message>
   <location filename="ui/widgets/study_frame.py" />
   <source>Compute for this particle</source>
   <translation>Für dieses Partikel berechnen</translation>
  </message>
  <message>
   <source>Convex hull instead of volume</source>
   <translation>Konvexe Hülle statt Volumen</translation>
  </message>
  <message>
   <source>Convex hull volume</source>
   <translation>Volumen der konvexen Hülle</translation>
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
   <location filename="ui/actions.py" />
   <source>Copy as &amp;Python</source>
   <translation>Als &amp;Python kopieren</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>Copy as co&amp;mmand</source>
   <translation>Als &amp;Kommando kopieren</translation>
  </message>
  <message>
   <location filename="ui/panels/log.py" />
   <location filename="ui/widgets/toast.py" />
   <source>Copy report</source>
   <translation>Bericht kopieren</translation>
  </message>
  <message>
   <location filename="ui/pages/sample/__init__.py" />
   <source>Copy the rows for a spreadsheet</source>
   <translation>Die Zeilen für eine Tabellenkalkulation kopieren</translation>
  </message>
  <message>
   <source>Corey shape factor</source>
   <translation>Formfaktor nach Corey</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/__init__.py" />
   <source>Cross-s&amp;ection</source>
   <translation>&amp;Querschnitt</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/section_panel.py" />
   <source>Cross-section</source>
   <translation>Querschnitt</translation>
  </message>
  <message>
   <location filename="ui/dialogs/shortcuts.py" />
   <source>Ctrl + drag</source>
   <translation>Strg + Ziehen</translation>
  </message>
  <message>
   <source>Ctrl+Shift+P finds any command by a few letters, Ctrl+Z takes back any choice, Ctrl+S keeps the project. The tour is in the Help menu. Have fun with the grains.</source>
   <translation>Strg+Umschalt+P findet jeden Befehl nach wenigen Buchstaben, Strg+Z nimmt jede Wahl zurück, Strg+S sichert das Projekt. Der Rundgang steht im Menü Hilfe. Viel Freude mit den Körnern!</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/__init__.py" />
   <source>Cut all views</source>
   <translation>Alle Ansichten schneiden</translation>
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
   <location filename="ui/dialogs/preferences.py" />
   <source>Dark</source>
   <translation>Dunkel</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch.py" />
   <location filename="ui/pages/dataset/__init__.py" />
   <source>Dataset</source>
   <translation>Datensatz</translation>
  </message>
  <message>
   <location filename="ui/panels/fit.py" />
   <source>Degree at which the series of Eq. 4 is cut: 0 is a sphere; the paper uses 10.</source>
   <translation>Grad, bei dem die Reihe von Gl. 4 abbricht: 0 ist eine Kugel; der Artikel nimmt 10.</translation>
  </message>
  <message>
   <location filename="ui/panels/spectrum.py" />
   <source>Degree l</source>
   <translation>Grad l</translation>
  </message>
  <message>
   <location filename="ui/widgets/preset_bar.py" />
   <source>Delete this preset</source>
   <translation>Diese Vorlage löschen</translation>
  </message>
  <message>
   <location filename="ui/panels/error_bars.py" />
   <source>Descriptor</source>
   <translation>Deskriptor</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch.py" />
   <location filename="ui/pages/explore/plot_area.py" />
   <location filename="ui/panels/descriptor_table.py" />
   <source>Descriptors</source>
   <translation>Deskriptoren</translation>
  </message>
  <message>
   <location filename="ui/widgets/toast.py" />
   <source>Details</source>
   <translation>Einzelheiten</translation>
  </message>
  <message>
   <location filename="ui/widgets/toast.py" />
   <source>Details …</source>
   <translation>Einzelheiten …</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/section_panel.py" />
   <source>Direction of the section</source>
   <translation>Richtung des Schnitts</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/section_panel.py" />
   <source>Distance from the middle of the particle; the frame in the views can be dragged as well.</source>
   <translation>Abstand von der Mitte des Partikels; auch der Rahmen in den Ansichten lässt sich ziehen.</translation>
  </message>
  <message>
   <location filename="ui/panels/fit.py" />
   <source>Divide by</source>
   <translation>Bezug</translation>
  </message>
  <message>
   <location filename="ui/tour.py" />
   <source>Done</source>
   <translation>Fertig</translation>
  </message>
  <message>
   <location filename="ui/batches.py" />
   <source>Done: {count} files in {folder}.</source>
   <translation>Fertig: {count} Dateien in {folder}.</translation>
  </message>
  <message>
   <source>Drag it. At 0 the fit is a sphere, at 10 it keeps what the paper keeps, at 30 nearly everything. The series of Eq. 4 is cut here.</source>
   <translation>Ziehen Sie daran. Bei 0 ist der Fit eine Kugel, bei 10 behält er, was der Artikel behält, bei 30 fast alles. Hier wird die Reihe von Gl. 4 abgebrochen.</translation>
  </message>
  <message>
   <location filename="ui/pages/model/__init__.py" />
   <source>Draw virtual particles with the shapes and sizes of a sample</source>
   <translation>Virtuelle Partikel mit den Formen und Größen einer Probe ziehen</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/pictures.py" />
   <source>Drawing the animation</source>
   <translation>Animation wird gezeichnet</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/pictures.py" />
   <source>Drawing the figure</source>
   <translation>Abbildung wird gezeichnet</translation>
  </message>
  <message>
   <location filename="jobs/fitting.py" />
   <source>Drawing the fit</source>
   <translation>Fit wird gezeichnet</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/pictures.py" />
   <source>Drawing the turntable</source>
   <translation>Drehung wird gezeichnet</translation>
  </message>
  <message>
   <location filename="ui/panels/particle_list.py" />
   <source>Drop mesh files or folders anywhere in the window to open them.</source>
   <translation>Netzdateien oder Ordner irgendwo im Fenster ablegen, um sie zu öffnen.</translation>
  </message>
  <message>
   <location filename="ui/pages/sample/__init__.py" />
   <source>E&amp;xport table …</source>
   <translation>Tabelle &amp;exportieren …</translation>
  </message>
  <message>
   <location filename="ui/dialogs/export.py" />
   <source>Each with</source>
   <translation>Jedes mit</translation>
  </message>
  <message>
   <location filename="ui/dialogs/unit.py" />
   <source>Edge of a voxel</source>
   <translation>Kante eines Voxels</translation>
  </message>
  <message>
   <location filename="ui/dialogs/unit.py" />
   <source>Edge of a voxel in micrometres</source>
   <translation>Kante eines Voxels in Mikrometern</translation>
  </message>
  <message>
   <source>Elongation</source>
   <translation>Elongation</translation>
  </message>
  <message>
   <location filename="ui/tour.py" />
   <source>End tour</source>
   <translation>Beenden</translation>
  </message>
  <message>
   <source>Equivalent radius</source>
   <translation>Äquivalentradius</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/plot_area.py" />
   <source>Errors</source>
   <translation>Fehler</translation>
  </message>
  <message>
   <location filename="ui/pages/studies/__init__.py" />
   <source>Errors against l_max, faces and weights, and what the polyhedra look like</source>
   <translation>Fehler gegen l_max, Facetten und Gewichte, und wie die Polyeder aussehen</translation>
  </message>
  <message>
   <source>Every open particle. Click a row to put it on screen; the arrow keys walk through the list. The icon tells the health of the mesh. Drop your own files anywhere in the window.</source>
   <translation>Alle geöffneten Partikel. Ein Klick auf eine Zeile zeigt eines davon; die Pfeiltasten wandern durch die Liste. Das Symbol sagt, wie gesund das Netz ist. Eigene Dateien lassen sich irgendwo im Fenster ablegen.</translation>
  </message>
  <message>
   <location filename="ui/pages/studies/__init__.py" />
   <source>Every study and the gallery</source>
   <translation>Alle Studien und die Galerie</translation>
  </message>
  <message>
   <source>Exact descriptors</source>
   <translation>Exakte Deskriptoren</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/__init__.py" />
   <source>Explore</source>
   <translation>Erkunden</translation>
  </message>
  <message>
   <location filename="ui/dialogs/export.py" />
   <source>Export</source>
   <translation>Exportieren</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>Export a DEM dataset</source>
   <translation>Einen DEM-Datensatz exportieren</translation>
  </message>
  <message>
   <location filename="ui/dialogs/export.py" />
   <source>Export dataset</source>
   <translation>Datensatz exportieren</translation>
  </message>
  <message>
   <location filename="ui/pages/lecture/__init__.py" />
   <source>F&amp;ull screen</source>
   <translation>Voll&amp;bild</translation>
  </message>
  <message>
   <location filename="ui/panels/coarsening.py" />
   <source>Facets n</source>
   <translation>Facetten n</translation>
  </message>
  <message>
   <source>Fewer facets make a faster simulation. The views say how many facets, vertices and triangles the polyhedron really has, and a sentence appears here if a wish cannot be met.</source>
   <translation>Weniger Facetten machen die Simulation schneller. Über der Ansicht steht, wie viele Facetten, Ecken und Dreiecke das Polyeder wirklich hat; hier erscheint ein Satz, wenn ein Wunsch nicht erfüllbar ist.</translation>
  </message>
  <message>
   <source>Figure 7, fifth column: aspect ratio and IoU</source>
   <translation>Bild 7, fünfte Spalte: Seitenverhältnis und IoU</translation>
  </message>
  <message>
   <source>Figure 7, fourth column; the surface area enters the loss as sphericity, as Eq. 8 has it</source>
   <translation>Bild 7, vierte Spalte; die Oberfläche geht, wie in Gl. 8, als Sphärizität in den Verlust ein</translation>
  </message>
  <message>
   <source>Figure 8, first row: all weights are 0, the quadric start is the result</source>
   <translation>Bild 8, erste Zeile: alle Gewichte sind 0, der Anfang aus der Quadrik-Dezimierung ist das Ergebnis</translation>
  </message>
  <message>
   <source>Figure 8, fourth row: IoU only</source>
   <translation>Bild 8, vierte Zeile: nur IoU</translation>
  </message>
  <message>
   <source>Figure 8: every term of Eq. 9 with weight 1</source>
   <translation>Bild 8: jeder Term von Gl. 9 mit Gewicht 1</translation>
  </message>
  <message>
   <source>Figures 7 and 8: every descriptor of section 2.2, without IoU</source>
   <translation>Bilder 7 und 8: jeder Deskriptor von Abschnitt 2.2, ohne IoU</translation>
  </message>
  <message>
   <location filename="ui/pages/repose/__init__.py" />
   <source>Fill a cylinder with the particles of a dataset, lift it, measure the pile</source>
   <translation>Einen Zylinder mit den Partikeln eines Datensatzes füllen, ihn heben, den Schüttkegel vermessen</translation>
  </message>
  <message>
   <location filename="ui/pages/scan/__init__.py" />
   <source>Find the grains in a CT volume and make particles of them</source>
   <translation>Die Körner in einem CT-Volumen finden und Partikel daraus machen</translation>
  </message>
  <message>
   <location filename="ui/panels/fit.py" />
   <source>First crossing</source>
   <translation>Erster Durchstoß</translation>
  </message>
  <message>
   <location filename="ui/panels/descriptor_table.py" />
   <source>Fit</source>
   <translation>Fit</translation>
  </message>
  <message>
   <location filename="ui/pages/model/__init__.py" />
   <source>Fit the &amp;model</source>
   <translation>&amp;Modell anpassen</translation>
  </message>
  <message>
   <location filename="ui/panels/error_bars.py" />
   <source>Fit vs. particle</source>
   <translation>Fit gegen Partikel</translation>
  </message>
  <message>
   <location filename="ui/views/triptych.py" />
   <source>Fit, {degree}</source>
   <translation>Fit, {degree}</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch.py" />
   <source>Fits</source>
   <translation>Fits</translation>
  </message>
  <message>
   <location filename="jobs/fitting.py" />
   <source>Fitting spherical harmonics</source>
   <translation>Kugelflächenfunktionen werden angepasst</translation>
  </message>
  <message>
   <source>Flatness</source>
   <translation>Abplattung</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/section_panel.py" />
   <source>Flip</source>
   <translation>Umkehren</translation>
  </message>
  <message>
   <location filename="ui/pages/repose/__init__.py" />
   <source>Folder of r&amp;uns …</source>
   <translation>Ordner der &amp;Läufe …</translation>
  </message>
  <message>
   <location filename="ui/dialogs/export.py" />
   <source>Folder of the dataset</source>
   <translation>Ordner des Datensatzes</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch.py" />
   <source>Folder of the results</source>
   <translation>Ordner der Ergebnisse</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch_fields.py" />
   <source>Folder with {names}</source>
   <translation>Ordner mit {names}</translation>
  </message>
  <message>
   <location filename="ui/dialogs/export.py" />
   <source>Folder:</source>
   <translation>Ordner:</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>For regolith-studio run</source>
   <translation>Für regolith-studio run</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>Forget sizes and borders</source>
   <translation>Größen und Grenzen vergessen</translation>
  </message>
  <message>
   <location filename="ui/dialogs/help.py" />
   <source>From X-ray micro-CT to DEM-ready regolith particles whose geometry is right.</source>
   <translation>Von der Röntgen-Mikro-CT zu DEM-fertigen Regolithpartikeln, deren Geometrie stimmt.</translation>
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
   <location filename="ui/pages/explore/__init__.py" />
   <source>GIF of l_max 0 to 30</source>
   <translation>GIF von l_max 0 bis 30</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch.py" />
   <source>Go on with the run that has not ended</source>
   <translation>Den nicht beendeten Lauf fortsetzen</translation>
  </message>
  <message>
   <location filename="ui/panels/particle_list.py" />
   <source>Group</source>
   <translation>Gruppe</translation>
  </message>
  <message>
   <location filename="ui/panels/coarsening.py" />
   <source>Half-spaces of Eq. 5; n facets in general position have 2n−4 vertices and 4n−12 triangles.</source>
   <translation>Halbräume von Gl. 5; n Facetten in allgemeiner Lage haben 2n−4 Ecken und 4n−12 Dreiecke.</translation>
  </message>
  <message>
   <location filename="ui/pages/scan/__init__.py" />
   <source>Hand the grains to all other pages</source>
   <translation>Die Körner an alle anderen Seiten geben</translation>
  </message>
  <message>
   <location filename="ui/views/triptych.py" />
   <source>Harmonics fit, {degree}</source>
   <translation>Kugelflächen-Fit, {degree}</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>Here or on a cluster</source>
   <translation>Hier oder auf einem Cluster</translation>
  </message>
  <message>
   <location filename="ui/panels/task_list.py" />
   <source>Hold it back after the step that it is at, or let it go on</source>
   <translation>Nach dem laufenden Schritt anhalten oder weiterlaufen lassen</translation>
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
   <location filename="ui/panels/fit.py" />
   <source>How radii are taken</source>
   <translation>Wie Radien bestimmt werden</translation>
  </message>
  <message>
   <location filename="ui/panels/coarsening.py" />
   <source>Imitate</source>
   <translation>Vorbild</translation>
  </message>
  <message>
   <location filename="ui/dialogs/export.py" />
   <source>Imitating</source>
   <translation>Vorbild</translation>
  </message>
  <message>
   <location filename="ui/dialogs/unit.py" />
   <source>In which unit are the numbers of these {count} files and folders?</source>
   <translation>In welcher Einheit sind die Zahlen dieser {count} Dateien und Ordner?</translation>
  </message>
  <message>
   <location filename="ui/dialogs/unit.py" />
   <source>In which unit are the numbers of {name}?</source>
   <translation>In welcher Einheit sind die Zahlen von {name}?</translation>
  </message>
  <message>
   <source>Intermediate diameter</source>
   <translation>Mittlerer Durchmesser</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch.py" />
   <source>Into:</source>
   <translation>Nach:</translation>
  </message>
  <message>
   <source>Isometric</source>
   <translation>Isometrisch</translation>
  </message>
  <message>
   <source>Iterations k_max</source>
   <translation>Iterationen k_max</translation>
  </message>
  <message>
   <location filename="ui/commands.py" />
   <source>Its choices are taken; it is too large to be opened: use Run as a batch.</source>
   <translation>Seine Einstellungen sind übernommen; zum Öffnen ist es zu groß: nehmen Sie „Als Stapel ausführen“.</translation>
  </message>
  <message>
   <location filename="ui/panels/loss.py" />
   <source>Jaccard distance</source>
   <translation>Jaccard-Distanz</translation>
  </message>
  <message>
   <location filename="ui/panels/loss.py" />
   <source>Jaccard distance, Eq. 7 (paper: IoU)</source>
   <translation>Jaccard-Distanz, Gl. 7 (im Artikel: IoU)</translation>
  </message>
  <message>
   <source>Keep the best so far</source>
   <translation>Das bisher Beste behalten</translation>
  </message>
  <message>
   <location filename="ui/panels/fit.py" />
   <source>Keep the volume</source>
   <translation>Volumen erhalten</translation>
  </message>
  <message>
   <location filename="ui/dialogs/closing.py" />
   <source>Keep working</source>
   <translation>Weiterarbeiten</translation>
  </message>
  <message>
   <location filename="ui/dialogs/shortcuts.py" />
   <source>Keyboard and mouse</source>
   <translation>Tastatur und Maus</translation>
  </message>
  <message>
   <location filename="ui/dialogs/shortcuts.py" />
   <source>Keys</source>
   <translation>Tasten</translation>
  </message>
  <message>
   <location filename="ui/dialogs/shortcuts.py" />
   <source>Keys:</source>
   <translation>Tasten:</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/pictures.py" />
   <source>Kind of picture</source>
   <translation>Art des Bildes</translation>
  </message>
  <message>
   <source>Krumbein sphericity</source>
   <translation>Sphärizität nach Krumbein</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>L&amp;og</source>
   <translation>&amp;Protokoll</translation>
  </message>
  <message>
   <location filename="ui/dialogs/preferences.py" />
   <source>Language</source>
   <translation>Sprache</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>Language, theme, size of letters</source>
   <translation>Sprache, Farbschema, Schriftgröße</translation>
  </message>
  <message>
   <source>Largest Feret diameter</source>
   <translation>Größter Feret-Durchmesser</translation>
  </message>
  <message>
   <location filename="ui/panels/lmax_study.py" />
   <source>Largest error in percent</source>
   <translation>Größter Fehler in Prozent</translation>
  </message>
  <message>
   <source>Largest moment of inertia</source>
   <translation>Größtes Trägheitsmoment</translation>
  </message>
  <message>
   <location filename="ui/panels/fit.py" />
   <source>Last crossing</source>
   <translation>Letzter Durchstoß</translation>
  </message>
  <message>
   <location filename="ui/panels/fit.py" />
   <source>Least hidden volume</source>
   <translation>Kleinstes verdecktes Volumen</translation>
  </message>
  <message>
   <source>Least moment of inertia</source>
   <translation>Kleinstes Trägheitsmoment</translation>
  </message>
  <message>
   <location filename="ui/pages/lecture/__init__.py" />
   <source>Lecture</source>
   <translation>Vorlesung</translation>
  </message>
  <message>
   <source>Left (from -x)</source>
   <translation>Links (von -x)</translation>
  </message>
  <message>
   <location filename="ui/dialogs/shortcuts.py" />
   <source>Left drag</source>
   <translation>Linke Taste ziehen</translation>
  </message>
  <message>
   <source>Left: the particle as the CT scan measured it. Middle: its spherical-harmonics fit. Right: the convex polyhedron that a DEM solver will roll. Drag to turn: all three turn together.</source>
   <translation>Links: das Partikel, wie die CT es gemessen hat. Mitte: sein Fit mit Kugelflächenfunktionen. Rechts: das konvexe Polyeder, das ein DEM-Programm rollen lässt. Zum Drehen ziehen: alle drei drehen sich gemeinsam.</translation>
  </message>
  <message>
   <location filename="ui/dialogs/unit.py" />
   <source>Length unit</source>
   <translation>Längeneinheit</translation>
  </message>
  <message>
   <source>Level</source>
   <translation>Stufe</translation>
  </message>
  <message>
   <location filename="ui/dialogs/preferences.py" />
   <source>Light</source>
   <translation>Hell</translation>
  </message>
  <message>
   <location filename="ui/activity.py" />
   <location filename="ui/panels/log.py" />
   <source>Log</source>
   <translation>Protokoll</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <location filename="ui/pages/explore/__init__.py" />
   <source>Look &amp;from</source>
   <translation>&amp;Blickrichtung</translation>
  </message>
  <message>
   <source>Looking for the cluster</source>
   <translation>Cluster wird gesucht</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/plot_area.py" />
   <source>Loss</source>
   <translation>Verlust</translation>
  </message>
  <message>
   <location filename="ui/panels/loss_curve.py" />
   <source>Loss (Eq. 9)</source>
   <translation>Verlust (Gl. 9)</translation>
  </message>
  <message>
   <location filename="ui/panels/fit.py" />
   <source>Maximum degree</source>
   <translation>Höchster Grad</translation>
  </message>
  <message>
   <source>Maximum diameter</source>
   <translation>Größter Durchmesser</translation>
  </message>
  <message>
   <location filename="ui/pages/repose/__init__.py" />
   <source>Measure the pile of another program</source>
   <translation>Den Schüttkegel eines anderen Programms vermessen</translation>
  </message>
  <message>
   <location filename="jobs/examining.py" />
   <source>Measuring</source>
   <translation>Vermessung</translation>
  </message>
  <message>
   <location filename="jobs/examining.py" />
   <source>Measuring particles</source>
   <translation>Partikel werden vermessen</translation>
  </message>
  <message>
   <source>Measuring the fit</source>
   <translation>Fit wird vermessen</translation>
  </message>
  <message>
   <location filename="ui/dialogs/unit.py" />
   <source>Mesh files carry no unit. The answer is kept for their folder.</source>
   <translation>Netzdateien tragen keine Einheit. Die Antwort wird für ihren Ordner gemerkt.</translation>
  </message>
  <message>
   <location filename="ui/dialogs/export.py" />
   <location filename="ui/panels/coarsening.py" />
   <source>Method</source>
   <translation>Verfahren</translation>
  </message>
  <message>
   <location filename="ui/dialogs/unit.py" />
   <source>Metres (m)</source>
   <translation>Meter (m)</translation>
  </message>
  <message>
   <location filename="ui/dialogs/unit.py" />
   <source>Micrometres (µm)</source>
   <translation>Mikrometer (µm)</translation>
  </message>
  <message>
   <source>Middle moment of inertia</source>
   <translation>Mittleres Trägheitsmoment</translation>
  </message>
  <message>
   <location filename="ui/dialogs/unit.py" />
   <source>Millimetres (mm)</source>
   <translation>Millimeter (mm)</translation>
  </message>
  <message>
   <source>Minimum diameter</source>
   <translation>Kleinster Durchmesser</translation>
  </message>
  <message>
   <location filename="ui/dialogs/shortcuts.py" />
   <source>Mouse in the views</source>
   <translation>Maus in den Ansichten</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch.py" />
   <source>Name a folder for the results.</source>
   <translation>Nennen Sie einen Ordner für die Ergebnisse.</translation>
  </message>
  <message>
   <location filename="ui/dialogs/export.py" />
   <source>Name a folder, new or empty.</source>
   <translation>Nennen Sie einen neuen oder leeren Ordner.</translation>
  </message>
  <message>
   <location filename="ui/panels/particle_list.py" />
   <source>Name and health of the mesh</source>
   <translation>Name und Zustand des Netzes</translation>
  </message>
  <message>
   <location filename="ui/dialogs/export.py" />
   <source>Name of the dataset</source>
   <translation>Name des Datensatzes</translation>
  </message>
  <message>
   <location filename="ui/widgets/preset_bar.py" />
   <source>Name of the preset:</source>
   <translation>Name der Vorlage:</translation>
  </message>
  <message>
   <location filename="ui/dialogs/export.py" />
   <source>Name:</source>
   <translation>Name:</translation>
  </message>
  <message>
   <location filename="ui/dialogs/unit.py" />
   <source>Nanometres (nm)</source>
   <translation>Nanometer (nm)</translation>
  </message>
  <message>
   <location filename="ui/dialogs/shortcuts.py" />
   <source>New keys of the chosen command</source>
   <translation>Neue Tasten des gewählten Befehls</translation>
  </message>
  <message>
   <location filename="ui/tour.py" />
   <source>Next</source>
   <translation>Weiter</translation>
  </message>
  <message>
   <location filename="ui/panels/coarsening.py" />
   <source>Next seed</source>
   <translation>Nächster Startwert</translation>
  </message>
  <message>
   <location filename="ui/panels/coarsening.py" />
   <source>Next seed: the same method with other random numbers</source>
   <translation>Nächster Startwert: dasselbe Verfahren mit anderen Zufallszahlen</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch_fields.py" />
   <source>No open particle comes from a file: open some, or choose a recipe file.</source>
   <translation>Kein geöffnetes Partikel stammt aus einer Datei: öffnen Sie welche oder wählen Sie eine Rezeptdatei.</translation>
  </message>
  <message>
   <location filename="ui/translation/sentences.py" />
   <source>No polyhedron with {faces} faces was found that meets all descriptors: {name} is off by {error} %; more faces or a weight of 0 would free it.</source>
   <translation>Es fand sich kein Polyeder mit {faces} Facetten, das alle Deskriptoren trifft: {name} weicht um {error} % ab; mehr Facetten oder ein Gewicht von 0 gäben Raum.</translation>
  </message>
  <message>
   <location filename="ui/panels/fit.py" />
   <source>Not fitted yet.</source>
   <translation>Noch nicht angepasst.</translation>
  </message>
  <message>
   <location filename="ui/panels/task_list.py" />
   <source>Nothing is running.</source>
   <translation>Nichts ist in Arbeit.</translation>
  </message>
  <message>
   <location filename="ui/panels/coarsening.py" />
   <source>Number of facets</source>
   <translation>Anzahl der Facetten</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch_fields.py" />
   <source>Number of processes</source>
   <translation>Anzahl der Prozesse</translation>
  </message>
  <message>
   <location filename="ui/panels/coarsening.py" />
   <source>Of all random numbers: the same seed gives the same polyhedron.</source>
   <translation>Aller Zufallszahlen: derselbe Startwert ergibt dasselbe Polyeder.</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/__init__.py" />
   <source>One after the other, then all</source>
   <translation>Eine nach der anderen, dann alle</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/__init__.py" />
   <source>One body over another</source>
   <translation>Ein Körper über einem anderen</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/__init__.py" />
   <source>One particle, its spherical-harmonics fit and its polyhedron side by side</source>
   <translation>Ein Partikel, sein Fit mit Kugelflächenfunktionen und sein Polyeder nebeneinander</translation>
  </message>
  <message>
   <source>One particle, three ways to see it</source>
   <translation>Ein Partikel, dreimal gesehen</translation>
  </message>
  <message>
   <location filename="ui/pages/lecture/__init__.py" />
   <source>One step</source>
   <translation>Ein Schritt</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/__init__.py" />
   <source>One turn: GIF, WebP, PNG files</source>
   <translation>Eine Umdrehung: GIF, WebP, PNG-Dateien</translation>
  </message>
  <message>
   <source>One weight for each term of the loss (Eq. 9), with the presets of the paper. A weight of 0 lets a descriptor go. Reset brings the preset back.</source>
   <translation>Ein Gewicht für jeden Term der Verlustfunktion (Gl. 9), mit den Vorlagen des Artikels. Das Gewicht 0 gibt einen Deskriptor frei. Zurücksetzen bringt die Vorlage zurück.</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>Open &amp;folder …</source>
   <translation>&amp;Ordner öffnen …</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>Open &amp;recent</source>
   <translation>&amp;Zuletzt geöffnet</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>Open &amp;sample</source>
   <translation>&amp;Probe öffnen</translation>
  </message>
  <message>
   <location filename="ui/pages/scan/__init__.py" />
   <source>Open &amp;volume …</source>
   <translation>&amp;Volumen öffnen …</translation>
  </message>
  <message>
   <location filename="ui/pages/repose/__init__.py" />
   <source>Open a &amp;dataset …</source>
   <translation>&amp;Datensatz öffnen …</translation>
  </message>
  <message>
   <location filename="ui/pages/model/__init__.py" />
   <source>Open a &amp;fit, model or card …</source>
   <translation>&amp;Fit, Modell oder Karte öffnen …</translation>
  </message>
  <message>
   <location filename="ui/pages/scan/__init__.py" />
   <source>Open a CT volume</source>
   <translation>Ein CT-Volumen öffnen</translation>
  </message>
  <message>
   <location filename="ui/commands.py" />
   <source>Open a folder of meshes</source>
   <translation>Einen Ordner mit Netzen öffnen</translation>
  </message>
  <message>
   <location filename="ui/pages/scan/__init__.py" />
   <source>Open a folder of s&amp;lices …</source>
   <translation>Ordner mit &amp;Schichtbildern öffnen …</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>Open mesh files</source>
   <translation>Netzdateien öffnen</translation>
  </message>
  <message>
   <location filename="ui/commands.py" />
   <source>Open particles</source>
   <translation>Partikel öffnen</translation>
  </message>
  <message>
   <location filename="ui/pages/scan/__init__.py" />
   <source>Open se&amp;ttings …</source>
   <translation>&amp;Einstellungen öffnen …</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch.py" />
   <source>Open the results</source>
   <translation>Ergebnisse öffnen</translation>
  </message>
  <message>
   <location filename="ui/pages/scan/__init__.py" />
   <source>Open the sample &amp;scan</source>
   <translation>&amp;Beispielscan öffnen</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>Open the shipped particles</source>
   <translation>Die mitgelieferten Partikel öffnen</translation>
  </message>
  <message>
   <location filename="ui/pages/model/__init__.py" />
   <source>Open what to draw from</source>
   <translation>Öffnen, woraus gezogen wird</translation>
  </message>
  <message>
   <source>Our own: mass and sieve size, the rest by overlap</source>
   <translation>Eigene: Masse und Siebgröße, das Übrige durch Überdeckung</translation>
  </message>
  <message>
   <source>Our own: the outer size counts and the volume gives way, since a convex body has only one of the two</source>
   <translation>Eigene: die äußere Größe zählt und das Volumen gibt nach, denn ein konvexer Körper hat nur eines von beiden</translation>
  </message>
  <message>
   <source>Overlap only</source>
   <translation>Nur Überdeckung</translation>
  </message>
  <message>
   <location filename="ui/panels/loss.py" />
   <source>Own preset</source>
   <translation>Eigene Vorlage</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>P&amp;references …</source>
   <translation>&amp;Einstellungen …</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/__init__.py" />
   <source>PNG</source>
   <translation>PNG</translation>
  </message>
  <message>
   <location filename="ui/page_stack.py" />
   <source>Page {title}</source>
   <translation>Seite {title}</translation>
  </message>
  <message>
   <location filename="ui/panels/descriptor_table.py" />
   <location filename="ui/panels/particle_list.py" />
   <source>Particle</source>
   <translation>Partikel</translation>
  </message>
  <message>
   <location filename="ui/dialogs/export.py" />
   <location filename="ui/panels/particle_list.py" />
   <source>Particles</source>
   <translation>Partikel</translation>
  </message>
  <message>
   <location filename="ui/commands.py" />
   <source>Particles (*.stl *.ply *.obj *.off *.glb *.gltf *.3mf *.anm *.sh *.shc)</source>
   <translation>Partikel (*.stl *.ply *.obj *.off *.glb *.gltf *.3mf *.anm *.sh *.shc)</translation>
  </message>
  <message>
   <location filename="ui/panels/particle_list.py" />
   <source>Particles ({count})</source>
   <translation>Partikel ({count})</translation>
  </message>
  <message>
   <location filename="ui/panels/task_list.py" />
   <source>Pause</source>
   <translation>Anhalten</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/pictures.py" />
   <source>Picture</source>
   <translation>Bild</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/pictures.py" />
   <source>Pictures (*.png)</source>
   <translation>Bilder (*.png)</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/section_panel.py" />
   <source>Place of the section</source>
   <translation>Ort des Schnitts</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch.py" />
   <source>Polyhedra (STL)</source>
   <translation>Polyeder (STL)</translation>
  </message>
  <message>
   <location filename="ui/panels/descriptor_table.py" />
   <location filename="ui/views/triptych.py" />
   <source>Polyhedron</source>
   <translation>Polyeder</translation>
  </message>
  <message>
   <location filename="ui/panels/error_bars.py" />
   <source>Polyhedron vs. fit</source>
   <translation>Polyeder gegen Fit</translation>
  </message>
  <message>
   <location filename="ui/panels/error_bars.py" />
   <source>Polyhedron vs. particle</source>
   <translation>Polyeder gegen Partikel</translation>
  </message>
  <message>
   <location filename="ui/views/triptych.py" />
   <source>Polyhedron, {count} facets</source>
   <translation>Polyeder, {count} Facetten</translation>
  </message>
  <message>
   <location filename="ui/dialogs/preferences.py" />
   <source>Preferences</source>
   <translation>Einstellungen</translation>
  </message>
  <message>
   <location filename="ui/panels/loss.py" />
   <source>Preset of weights</source>
   <translation>Vorlage der Gewichte</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch_fields.py" />
   <source>Processes</source>
   <translation>Prozesse</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch_fields.py" />
   <source>Processes of this machine</source>
   <translation>Prozesse dieses Rechners</translation>
  </message>
  <message>
   <location filename="ui/panels/task_list.py" />
   <location filename="ui/panels/tasks.py" />
   <source>Progress</source>
   <translation>Fortschritt</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch.py" />
   <source>Progress of the batch</source>
   <translation>Fortschritt des Stapels</translation>
  </message>
  <message>
   <location filename="ui/dialogs/export.py" />
   <source>Progress of the export</source>
   <translation>Fortschritt des Exports</translation>
  </message>
  <message>
   <location filename="ui/widgets/study_frame.py" />
   <source>Progress of the study</source>
   <translation>Fortschritt der Studie</translation>
  </message>
  <message>
   <location filename="ui/commands.py" />
   <location filename="ui/projects.py" />
   <source>Projects (*.regolith)</source>
   <translation>Projekte (*.regolith)</translation>
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
   <location filename="session/studies.py" />
   <source>RMSRE against l_max</source>
   <translation>RMSRE gegen l_max</translation>
  </message>
  <message>
   <location filename="session/studies.py" />
   <source>RMSRE against loss weights</source>
   <translation>RMSRE gegen die Gewichte des Verlusts</translation>
  </message>
  <message>
   <location filename="ui/panels/fit.py" />
   <source>Radius</source>
   <translation>Radius</translation>
  </message>
  <message>
   <location filename="ui/panels/fit.py" />
   <source>Radius rule</source>
   <translation>Regel für Radien</translation>
  </message>
  <message>
   <location filename="jobs/loading.py" />
   <source>Reading particles</source>
   <translation>Partikel werden gelesen</translation>
  </message>
  <message>
   <location filename="jobs/loading.py" />
   <source>Reading the sample</source>
   <translation>Probe wird gelesen</translation>
  </message>
  <message>
   <location filename="ui/panels/tasks.py" />
   <source>Ready</source>
   <translation>Bereit</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch_fields.py" />
   <source>Recipe</source>
   <translation>Rezept</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch.py" />
   <source>Recipe:</source>
   <translation>Rezept:</translation>
  </message>
  <message>
   <location filename="ui/commands.py" />
   <location filename="ui/dialogs/batch_fields.py" />
   <source>Recipes (*.json)</source>
   <translation>Rezepte (*.json)</translation>
  </message>
  <message>
   <location filename="ui/projects.py" />
   <source>Recover</source>
   <translation>Wiederherstellen</translation>
  </message>
  <message>
   <location filename="ui/panels/fit.py" />
   <source>Reference of the radius</source>
   <translation>Bezug der Radien</translation>
  </message>
  <message>
   <location filename="ui/projects.py" />
   <source>Regolith Studio was not closed properly the last time. Bring its state back?</source>
   <translation>Regolith Studio wurde zuletzt nicht ordentlich geschlossen. Den Stand zurückholen?</translation>
  </message>
  <message>
   <location filename="ui/panels/error_bars.py" />
   <source>Relative error [%]</source>
   <translation>Relativer Fehler [%]</translation>
  </message>
  <message>
   <location filename="ui/panels/loss.py" />
   <source>Relative error of {symbol}, Eq. 8: {name}, {formula}</source>
   <translation>Relativer Fehler von {symbol}, Gl. 8: {name}, {formula}</translation>
  </message>
  <message>
   <source>Relative errors of volume, sphericity, diameters, aspect ratio and hull (Eq. 8): blue for the fit, orange for the polyhedron. The second tab has the numbers with their units.</source>
   <translation>Relative Fehler von Volumen, Sphärizität, Durchmessern, Seitenverhältnis und Hülle (Gl. 8): blau für den Fit, orange für das Polyeder. Der zweite Reiter hat die Zahlen mit ihren Einheiten.</translation>
  </message>
  <message>
   <source>Repair lost facets</source>
   <translation>Verlorene Facetten ersetzen</translation>
  </message>
  <message>
   <location filename="ui/dialogs/export.py" />
   <source>Replace the dataset that is there</source>
   <translation>Den vorhandenen Datensatz ersetzen</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch.py" />
   <source>Report (HTML)</source>
   <translation>Bericht (HTML)</translation>
  </message>
  <message>
   <location filename="ui/widgets/preset_bar.py" />
   <source>Reset</source>
   <translation>Zurücksetzen</translation>
  </message>
  <message>
   <source>Restore the volume</source>
   <translation>Volumen wiederherstellen</translation>
  </message>
  <message>
   <location filename="ui/panels/task_list.py" />
   <source>Resume</source>
   <translation>Fortsetzen</translation>
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
   <location filename="ui/dialogs/shortcuts.py" />
   <source>Right or middle drag, Shift + drag</source>
   <translation>Rechte oder mittlere Taste ziehen, Umschalt + Ziehen</translation>
  </message>
  <message>
   <location filename="ui/dialogs/shortcuts.py" />
   <source>Roll the picture</source>
   <translation>Das Bild rollen</translation>
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
   <location filename="ui/dialogs/batch.py" />
   <source>Run</source>
   <translation>Ausführen</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>Run as a &amp;batch …</source>
   <translation>Als S&amp;tapel ausführen …</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch.py" />
   <source>Run as a batch</source>
   <translation>Als Stapel ausführen</translation>
  </message>
  <message>
   <location filename="ui/pages/repose/__init__.py" />
   <source>Run the values of the study, or go on</source>
   <translation>Die Werte der Studie rechnen oder fortfahren</translation>
  </message>
  <message>
   <location filename="ui/batches.py" />
   <source>Running the recipe</source>
   <translation>Rezept wird ausgeführt</translation>
  </message>
  <message>
   <location filename="ui/pages/lecture/__init__.py" />
   <source>S&amp;maller letters</source>
   <translation>&amp;Kleinere Schrift</translation>
  </message>
  <message>
   <location filename="ui/pages/scan/__init__.py" />
   <source>Sa&amp;ve settings …</source>
   <translation>Einstellungen spei&amp;chern …</translation>
  </message>
  <message>
   <location filename="ui/pages/sample/__init__.py" />
   <source>Sample</source>
   <translation>Probe</translation>
  </message>
  <message>
   <location filename="ui/panels/particle_list.py" />
   <source>Sample or size fraction</source>
   <translation>Probe oder Größenklasse</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/__init__.py" />
   <source>Save &amp;animation of l_max …</source>
   <translation>&amp;Animation von l_max speichern …</translation>
  </message>
  <message>
   <location filename="ui/widgets/plot.py" />
   <source>Save &amp;figure …</source>
   <translation>&amp;Abbildung speichern …</translation>
  </message>
  <message>
   <location filename="ui/widgets/plot.py" />
   <source>Save &amp;numbers …</source>
   <translation>&amp;Zahlen speichern …</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/__init__.py" />
   <source>Save &amp;picture …</source>
   <translation>&amp;Bild speichern …</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/__init__.py" />
   <source>Save &amp;turntable …</source>
   <translation>&amp;Drehung speichern …</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/pictures.py" />
   <source>Save animation</source>
   <translation>Animation speichern</translation>
  </message>
  <message>
   <location filename="ui/widgets/preset_bar.py" />
   <source>Save as own preset</source>
   <translation>Als eigene Vorlage speichern</translation>
  </message>
  <message>
   <location filename="ui/widgets/preset_bar.py" />
   <source>Save as own preset …</source>
   <translation>Als eigene Vorlage speichern …</translation>
  </message>
  <message>
   <location filename="ui/widgets/plot.py" />
   <source>Save figure</source>
   <translation>Abbildung speichern</translation>
  </message>
  <message>
   <location filename="ui/pages/model/__init__.py" />
   <source>Save material &amp;card …</source>
   <translation>Material&amp;karte speichern …</translation>
  </message>
  <message>
   <location filename="ui/widgets/plot.py" />
   <source>Save numbers</source>
   <translation>Zahlen speichern</translation>
  </message>
  <message>
   <location filename="ui/widgets/preset_bar.py" />
   <source>Save or delete a preset</source>
   <translation>Vorlage speichern oder löschen</translation>
  </message>
  <message>
   <location filename="ui/widgets/preset_bar.py" />
   <source>Save or delete a preset of your own</source>
   <translation>Eine eigene Vorlage speichern oder löschen</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/pictures.py" />
   <source>Save picture</source>
   <translation>Bild speichern</translation>
  </message>
  <message>
   <location filename="ui/projects.py" />
   <source>Save project</source>
   <translation>Projekt speichern</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>Save project &amp;as …</source>
   <translation>Projekt speichern &amp;unter …</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>Save re&amp;cipe …</source>
   <translation>&amp;Rezept speichern …</translation>
  </message>
  <message>
   <location filename="ui/commands.py" />
   <source>Save recipe</source>
   <translation>Rezept speichern</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/pictures.py" />
   <source>Save turntable</source>
   <translation>Drehung speichern</translation>
  </message>
  <message>
   <location filename="ui/commands.py" />
   <source>Saved {name}; run it with: {command}</source>
   <translation>{name} ist gespeichert; ausführen mit: {command}</translation>
  </message>
  <message>
   <location filename="ui/projects.py" />
   <source>Saved {path}.</source>
   <translation>{path} ist gespeichert.</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/pictures.py" />
   <source>Scale</source>
   <translation>Maßstab</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/pictures.py" />
   <source>Scale of the picture</source>
   <translation>Maßstab des Bildes</translation>
  </message>
  <message>
   <location filename="ui/pages/scan/__init__.py" />
   <source>Scan</source>
   <translation>Scan</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch_fields.py" />
   <source>Scheduler</source>
   <translation>Scheduler</translation>
  </message>
  <message>
   <location filename="ui/dialogs/shortcuts.py" />
   <source>Search commands</source>
   <translation>Befehle suchen</translation>
  </message>
  <message>
   <location filename="ui/dialogs/shortcuts.py" />
   <source>Search commands and keys</source>
   <translation>Befehle und Tasten suchen</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/plot_area.py" />
   <source>Section</source>
   <translation>Schnitt</translation>
  </message>
  <message>
   <source>See why it works</source>
   <translation>Sehen, warum es geht</translation>
  </message>
  <message>
   <location filename="ui/panels/coarsening.py" />
   <source>Seed</source>
   <translation>Startwert</translation>
  </message>
  <message>
   <location filename="ui/pages/scan/__init__.py" />
   <source>Segment the whole volume</source>
   <translation>Das ganze Volumen segmentieren</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/pictures.py" />
   <source>Sequence of PNG files (*.png)</source>
   <translation>Folge von PNG-Dateien (*.png)</translation>
  </message>
  <message>
   <location filename="ui/panels/coarsening.py" />
   <source>Settings of the method</source>
   <translation>Einstellungen des Verfahrens</translation>
  </message>
  <message>
   <location filename="ui/pages/model/__init__.py" />
   <source>Shape model</source>
   <translation>Formmodell</translation>
  </message>
  <message>
   <location filename="ui/dialogs/shortcuts.py" />
   <source>Shift the picture</source>
   <translation>Das Bild verschieben</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/__init__.py" />
   <source>Show fitting errors</source>
   <translation>Fehler des Fits zeigen</translation>
  </message>
  <message>
   <location filename="ui/pages/sample/__init__.py" />
   <source>Show in &amp;Explore</source>
   <translation>In Er&amp;kunden zeigen</translation>
  </message>
  <message>
   <location filename="ui/pages/dataset/__init__.py" />
   <source>Show the &amp;library</source>
   <translation>Bib&amp;liothek zeigen</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/__init__.py" />
   <source>Show the whole particle</source>
   <translation>Das ganze Partikel zeigen</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/__init__.py" />
   <source>Show triangles</source>
   <translation>Dreiecke zeigen</translation>
  </message>
  <message>
   <source>Simulated annealing (paper)</source>
   <translation>Simuliertes Abkühlen (Artikel)</translation>
  </message>
  <message>
   <location filename="ui/dialogs/preferences.py" />
   <source>Size of letters</source>
   <translation>Schriftgröße</translation>
  </message>
  <message>
   <source>Smallest Feret diameter</source>
   <translation>Kleinster Feret-Durchmesser</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/__init__.py" />
   <source>Smallest in volume</source>
   <translation>Der kleinste dem Volumen nach</translation>
  </message>
  <message>
   <location filename="ui/app.py" />
   <source>Something went wrong in the program ({name}); the work goes on.</source>
   <translation>Im Programm ist etwas schiefgegangen ({name}); die Arbeit geht weiter.</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/plot_area.py" />
   <source>Spectrum</source>
   <translation>Spektrum</translation>
  </message>
  <message>
   <location filename="ui/panels/fit.py" />
   <source>Sphere</source>
   <translation>Kugel</translation>
  </message>
  <message>
   <location filename="ui/panels/coarsening.py" />
   <location filename="ui/panels/fit.py" />
   <location filename="ui/views/triptych.py" />
   <source>Spherical-harmonics fit</source>
   <translation>Fit mit Kugelflächenfunktionen</translation>
  </message>
  <message>
   <location filename="ui/views/triptych.py" />
   <source>Spherical-harmonics fit, {degree}</source>
   <translation>Fit mit Kugelflächenfunktionen, {degree}</translation>
  </message>
  <message>
   <source>Sphericity</source>
   <translation>Sphärizität</translation>
  </message>
  <message>
   <location filename="ui/translation/sentences.py" />
   <source>Sphericity {sphericity} needs at least {needed} faces; with {faces} the most is {most}.</source>
   <translation>Die Sphärizität {sphericity} braucht mindestens {needed} Facetten; mit {faces} sind höchstens {most} möglich.</translation>
  </message>
  <message>
   <location filename="ui/translation/sentences.py" />
   <source>Sphericity {sphericity} needs more than 100,000 faces; with {faces} the most is {most}.</source>
   <translation>Die Sphärizität {sphericity} braucht mehr als 100,000 Facetten; mit {faces} sind höchstens {most} möglich.</translation>
  </message>
  <message>
   <location filename="ui/panels/particle_list.py" />
   <source>Sphericity, Eq. 1 (Wadell)</source>
   <translation>Sphärizität, Gl. 1 (Wadell)</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>Standard la&amp;yout</source>
   <translation>&amp;Standardanordnung</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/__init__.py" />
   <source>Star &amp;point</source>
   <translation>S&amp;ternpunkt</translation>
  </message>
  <message>
   <location filename="ui/panels/fit.py" />
   <source>Star point</source>
   <translation>Sternpunkt</translation>
  </message>
  <message>
   <location filename="ui/panels/fit.py" />
   <source>Star-shaped: no part of the surface is hidden from the star point.</source>
   <translation>Sternförmig: kein Teil der Oberfläche ist vom Sternpunkt aus verdeckt.</translation>
  </message>
  <message>
   <source>Start temperature T₀</source>
   <translation>Anfangstemperatur T₀</translation>
  </message>
  <message>
   <location filename="ui/pages/repose/__init__.py" />
   <source>Start the &amp;study</source>
   <translation>&amp;Studie starten</translation>
  </message>
  <message>
   <source>Starting the workers</source>
   <translation>Arbeitsprozesse werden gestartet</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch.py" />
   <location filename="ui/dialogs/export.py" />
   <source>Starting …</source>
   <translation>Beginnt …</translation>
  </message>
  <message>
   <location filename="ui/panels/loss_curve.py" />
   <source>Step</source>
   <translation>Schritt</translation>
  </message>
  <message>
   <location filename="ui/pages/lecture/__init__.py" />
   <source>Step &amp;back</source>
   <translation>Schritt &amp;zurück</translation>
  </message>
  <message>
   <location filename="ui/pages/lecture/__init__.py" />
   <source>Step &amp;forward</source>
   <translation>Schritt &amp;vor</translation>
  </message>
  <message>
   <location filename="ui/pages/lecture/__init__.py" />
   <source>Step by step</source>
   <translation>Schritt für Schritt</translation>
  </message>
  <message>
   <source>Step, in mean |p|</source>
   <translation>Schrittweite in mittleren |p|</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch.py" />
   <location filename="ui/panels/task_list.py" />
   <location filename="ui/panels/tasks.py" />
   <location filename="ui/widgets/study_frame.py" />
   <source>Stop</source>
   <translation>Abbrechen</translation>
  </message>
  <message>
   <location filename="ui/dialogs/closing.py" />
   <source>Stop and close</source>
   <translation>Abbrechen und schließen</translation>
  </message>
  <message>
   <location filename="ui/panels/tasks.py" />
   <source>Stop what is running</source>
   <translation>Abbrechen, was in Arbeit ist</translation>
  </message>
  <message>
   <location filename="ui/batches.py" />
   <source>Stopped. What was done is kept: run again into the same folder to go on.</source>
   <translation>Abgebrochen. Was fertig ist, bleibt: noch einmal in denselben Ordner ausführen setzt es fort.</translation>
  </message>
  <message>
   <location filename="ui/pages/studies/__init__.py" />
   <source>Studies</source>
   <translation>Studien</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch.py" />
   <source>Study of the coarsening</source>
   <translation>Studie der Vergröberung</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch.py" />
   <source>Study of the degree</source>
   <translation>Studie des Grades</translation>
  </message>
  <message>
   <source>Surface area</source>
   <translation>Oberfläche</translation>
  </message>
  <message>
   <location filename="ui/commands.py" />
   <source>Tables of coefficients (*.anm *.sh *.shc *.txt *.dat *.csv)</source>
   <translation>Tabellen von Koeffizienten (*.anm *.sh *.shc *.txt *.dat *.csv)</translation>
  </message>
  <message>
   <location filename="ui/pages/scan/__init__.py" />
   <source>Take settings from a file</source>
   <translation>Einstellungen aus einer Datei nehmen</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/section_panel.py" />
   <source>Take the other half away</source>
   <translation>Die andere Hälfte wegnehmen</translation>
  </message>
  <message>
   <location filename="ui/activity.py" />
   <source>Tasks</source>
   <translation>Aufgaben</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/pictures.py" />
   <source>The animation is in {path}.</source>
   <translation>Die Animation ist in {path}.</translation>
  </message>
  <message>
   <location filename="ui/translation/sentences.py" />
   <source>The centre of mass lies outside the particle; the point with the least hidden volume is used.</source>
   <translation>Der Schwerpunkt liegt außerhalb des Partikels; genommen wird der Punkt mit dem kleinsten verdeckten Volumen.</translation>
  </message>
  <message>
   <location filename="ui/commands.py" />
   <source>The command is on the clipboard.</source>
   <translation>Das Kommando ist in der Zwischenablage.</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>The command line that does the same</source>
   <translation>Die Kommandozeile, die dasselbe tut</translation>
  </message>
  <message>
   <location filename="ui/commands.py" />
   <source>The dataset is in {folder}.</source>
   <translation>Der Datensatz ist in {folder}.</translation>
  </message>
  <message>
   <location filename="ui/panels/error_bars.py" />
   <source>The errors appear when the fit is measured.</source>
   <translation>Die Fehler erscheinen, sobald der Fit vermessen ist.</translation>
  </message>
  <message>
   <location filename="ui/translation/sentences.py" />
   <source>The expansion up to l = {degree} misses the radius by {error} in the root mean square, at most {most}: it oscillates, as it does on flat and elongated grains.</source>
   <translation>Die Entwicklung bis l = {degree} verfehlt den Radius im quadratischen Mittel um {error}, höchstens um {most}: sie schwingt, wie sie es bei flachen und länglichen Körnern tut.</translation>
  </message>
  <message>
   <location filename="ui/translation/sentences.py" />
   <source>The expansion up to l = {degree} misses the radius by {error} in the root mean square: it oscillates, as it does on flat and elongated grains.</source>
   <translation>Die Entwicklung bis l = {degree} verfehlt den Radius im quadratischen Mittel um {error}: sie schwingt, wie sie es bei flachen und länglichen Körnern tut.</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch_fields.py" />
   <source>The files of the {count} open particles, as chosen now</source>
   <translation>Die Dateien der {count} geöffneten Partikel, wie jetzt eingestellt</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch.py" />
   <source>The folder holds a run that has not ended: go on with it, or choose another folder.</source>
   <translation>Im Ordner liegt ein nicht beendeter Lauf: setzen Sie ihn fort oder wählen Sie einen anderen Ordner.</translation>
  </message>
  <message>
   <location filename="ui/dialogs/export.py" />
   <source>The folder is not empty: choose another one, or replace the dataset in it.</source>
   <translation>Der Ordner ist nicht leer: wählen Sie einen anderen oder ersetzen Sie den Datensatz darin.</translation>
  </message>
  <message>
   <location filename="ui/dialogs/preferences.py" />
   <source>The language takes effect when the program starts again.</source>
   <translation>Die Sprache gilt ab dem nächsten Start des Programms.</translation>
  </message>
  <message>
   <location filename="ui/panels/loss_curve.py" />
   <source>The loss appears when the coarsening begins.</source>
   <translation>Der Verlust erscheint, sobald die Vergröberung beginnt.</translation>
  </message>
  <message>
   <source>The loss falls while the coarsening runs; the spectrum shows which degrees are kept. Nothing here blocks the window: what runs is in the status bar and can be stopped there.</source>
   <translation>Der Verlust fällt, während die Vergröberung läuft; das Spektrum zeigt, welche Grade erhalten bleiben. Nichts davon blockiert das Fenster: was in Arbeit ist, steht in der Statuszeile und lässt sich dort abbrechen.</translation>
  </message>
  <message>
   <location filename="ui/main_window.py" />
   <source>The next window stands as a new one.</source>
   <translation>Das nächste Fenster steht wie ein neues.</translation>
  </message>
  <message>
   <source>The page Lecture shows the ideas one step at a time, each formula with its numbers: the annealing, the degrees of the fit, a random field. Ctrl+Space plays, the page keys step, Ctrl++ enlarges the letters, F11 fills the screen.</source>
   <translation>Die Seite Vorlesung zeigt die Gedanken Schritt für Schritt, jede Formel mit ihren Zahlen: das simulierte Abkühlen, die Grade des Fits, ein Zufallsfeld. Strg+Leertaste spielt ab, die Bildtasten gehen einen Schritt, Strg++ vergrößert die Schrift, F11 füllt den Bildschirm.</translation>
  </message>
  <message>
   <source>The pages follow the work: find grains in a scan, model their shape and draw new ones, build a dataset for Rocky, YADE or LAMMPS, and measure the angle of repose.</source>
   <translation>Die Seiten folgen der Arbeit: Körner in einem Scan finden, ihre Form modellieren und neue ziehen, einen Datensatz für Rocky, YADE oder LAMMPS bauen und den Schüttwinkel messen.</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/pictures.py" />
   <source>The picture is in {path}.</source>
   <translation>Das Bild ist in {path}.</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/pictures.py" />
   <source>The picture {path} cannot be written.</source>
   <translation>Das Bild {path} lässt sich nicht schreiben.</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch.py" />
   <source>The results are the same bytes whoever works, and a run that was stopped can go on.</source>
   <translation>Die Ergebnisse sind Byte für Byte dieselben, wer auch arbeitet, und ein abgebrochener Lauf lässt sich fortsetzen.</translation>
  </message>
  <message>
   <source>The sample</source>
   <translation>Die Probe</translation>
  </message>
  <message>
   <location filename="ui/commands.py" />
   <source>The script is on the clipboard.</source>
   <translation>Das Skript ist in der Zwischenablage.</translation>
  </message>
  <message>
   <location filename="ui/panels/spectrum.py" />
   <source>The spectrum appears when the particle is fitted.</source>
   <translation>Das Spektrum erscheint, sobald das Partikel angepasst ist.</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/pictures.py" />
   <source>The turntable is in {path}.</source>
   <translation>Die Drehung ist in {path}.</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/pictures.py" />
   <source>The views as they are seen</source>
   <translation>Die Ansichten, wie man sie sieht</translation>
  </message>
  <message>
   <source>The whole sample</source>
   <translation>Die ganze Probe</translation>
  </message>
  <message>
   <location filename="ui/dialogs/preferences.py" />
   <source>Theme</source>
   <translation>Farbschema</translation>
  </message>
  <message>
   <location filename="ui/commands.py" />
   <source>There is nothing to export: open a particle first.</source>
   <translation>Es gibt nichts zu exportieren: öffnen Sie zuerst ein Partikel.</translation>
  </message>
  <message>
   <location filename="ui/dialogs/help.py" />
   <source>Three-dimensional views: {how}</source>
   <translation>Dreidimensionale Ansichten: {how}</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>Tools</source>
   <translation>Werkzeuge</translation>
  </message>
  <message>
   <source>Top (from +z)</source>
   <translation>Oben (von +z)</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/pictures.py" />
   <source>Transparent background</source>
   <translation>Durchsichtiger Hintergrund</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/__init__.py" />
   <source>Turn all views together</source>
   <translation>Alle Ansichten gemeinsam drehen</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/section_panel.py" />
   <source>Turn the cross-section on in the tool bar.</source>
   <translation>Schalten Sie den Querschnitt in der Werkzeugleiste ein.</translation>
  </message>
  <message>
   <location filename="ui/dialogs/shortcuts.py" />
   <source>Turn the particle</source>
   <translation>Das Partikel drehen</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/__init__.py" />
   <source>Two bodies beside a line</source>
   <translation>Zwei Körper beiderseits einer Linie</translation>
  </message>
  <message>
   <location filename="ui/dialogs/command_palette.py" />
   <source>Type a command</source>
   <translation>Befehl eintippen</translation>
  </message>
  <message>
   <location filename="ui/dialogs/unit.py" />
   <source>Unit</source>
   <translation>Einheit</translation>
  </message>
  <message>
   <location filename="ui/dialogs/shortcuts.py" />
   <source>Usual keys</source>
   <translation>Übliche Tasten</translation>
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
   <source>V of the hull</source>
   <translation>V der Hülle</translation>
  </message>
  <message>
   <location filename="ui/panels/particle_list.py" />
   <source>Volume</source>
   <translation>Volumen</translation>
  </message>
  <message>
   <source>Volume and box</source>
   <translation>Volumen und Hüllquader</translation>
  </message>
  <message>
   <source>Volume, surface area, aspect ratio</source>
   <translation>Volumen, Oberfläche, Seitenverhältnis</translation>
  </message>
  <message>
   <location filename="ui/dialogs/unit.py" />
   <source>Voxels of a CT volume</source>
   <translation>Voxel eines CT-Volumens</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/pictures.py" />
   <source>Wait until the particle is fitted.</source>
   <translation>Warten Sie, bis das Partikel angepasst ist.</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/pictures.py" />
   <source>Wait until the three views are drawn.</source>
   <translation>Warten Sie, bis die drei Ansichten gezeichnet sind.</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/pictures.py" />
   <source>Wait until the views are drawn.</source>
   <translation>Warten Sie, bis die Ansichten gezeichnet sind.</translation>
  </message>
  <message>
   <source>Watch it work</source>
   <translation>Bei der Arbeit zusehen</translation>
  </message>
  <message>
   <location filename="ui/panels/loss.py" />
   <source>Weight of {name}</source>
   <translation>Gewicht: {name}</translation>
  </message>
  <message>
   <location filename="ui/dialogs/export.py" />
   <source>Weights</source>
   <translation>Gewichte</translation>
  </message>
  <message>
   <location filename="ui/panels/loss.py" />
   <source>Weights of the loss (Eq. 9)</source>
   <translation>Gewichte der Verlustfunktion (Gl. 9)</translation>
  </message>
  <message>
   <location filename="ui/widgets/toast.py" />
   <source>What happened</source>
   <translation>Was geschehen ist</translation>
  </message>
  <message>
   <location filename="ui/panels/coarsening.py" />
   <source>What is imitated</source>
   <translation>Was nachgebildet wird</translation>
  </message>
  <message>
   <location filename="ui/views/view_frame.py" />
   <source>What is laid over it, or shown to the right of the line</source>
   <translation>Was darübergelegt oder rechts der Linie gezeigt wird</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>What is running</source>
   <translation>Was in Arbeit ist</translation>
  </message>
  <message>
   <source>What matters to you</source>
   <translation>Worauf es Ihnen ankommt</translation>
  </message>
  <message>
   <location filename="ui/panels/fit.py" />
   <source>What radii are divided by before they are expanded. An ellipsoid lowers the oscillation on flat and elongated grains.</source>
   <translation>Wodurch Radien geteilt werden, bevor sie entwickelt werden. Ein Ellipsoid mindert das Schwingen bei flachen und länglichen Körnern.</translation>
  </message>
  <message>
   <source>What the fit and the polyhedron keep</source>
   <translation>Was Fit und Polyeder bewahren</translation>
  </message>
  <message>
   <location filename="ui/actions.py" />
   <source>What was said</source>
   <translation>Was gesagt wurde</translation>
  </message>
  <message>
   <location filename="ui/dialogs/shortcuts.py" />
   <source>Wheel</source>
   <translation>Rad</translation>
  </message>
  <message>
   <location filename="ui/panels/fit.py" />
   <source>Where radii begin. Automatic: the centre of mass or, where that is not inside, the point that hides the least volume.</source>
   <translation>Wo Radien beginnen. Automatisch: der Schwerpunkt oder, wo dieser nicht im Inneren liegt, der Punkt, der am wenigsten Volumen verdeckt.</translation>
  </message>
  <message>
   <source>Where to go from here</source>
   <translation>Wie es weitergeht</translation>
  </message>
  <message>
   <location filename="ui/panels/fit.py" />
   <source>Which radius counts where a ray crosses the surface more than once. Keep the volume: the cube root of the signed sum of r³ over all crossings.</source>
   <translation>Welcher Radius zählt, wo ein Strahl die Oberfläche mehrmals durchstößt. Volumen erhalten: die Kubikwurzel der vorzeichenbehafteten Summe von r³ über alle Durchstöße.</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/__init__.py" />
   <source>Wi&amp;pe</source>
   <translation>&amp;Wischblende</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch_fields.py" />
   <source>Work done by</source>
   <translation>Ausführung durch</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch.py" />
   <source>Work done by:</source>
   <translation>Ausführung durch:</translation>
  </message>
  <message>
   <location filename="session/performing.py" />
   <source>Working on particles</source>
   <translation>Partikel werden bearbeitet</translation>
  </message>
  <message>
   <location filename="ui/pages/scan/__init__.py" />
   <source>Write settings for the next scan</source>
   <translation>Einstellungen für den nächsten Scan schreiben</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch.py" />
   <source>Write:</source>
   <translation>Schreiben:</translation>
  </message>
  <message>
   <source>Writing the dataset</source>
   <translation>Datensatz wird geschrieben</translation>
  </message>
  <message>
   <location filename="session/performing.py" />
   <source>Writing the results</source>
   <translation>Ergebnisse werden geschrieben</translation>
  </message>
  <message>
   <location filename="ui/dialogs/shortcuts.py" />
   <source>Zoom</source>
   <translation>Vergrößern und verkleinern</translation>
  </message>
  <message>
   <source>about the centroid</source>
   <translation>um den Schwerpunkt</translation>
  </message>
  <message>
   <location filename="ui/panels/task_list.py" />
   <source>about {hours:.1f} h left</source>
   <translation>noch etwa {hours:.1f} h</translation>
  </message>
  <message>
   <location filename="ui/panels/task_list.py" />
   <source>about {minutes} min left</source>
   <translation>noch etwa {minutes} min</translation>
  </message>
  <message>
   <location filename="ui/panels/task_list.py" />
   <source>about {seconds} s left</source>
   <translation>noch etwa {seconds} s</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/section_panel.py" />
   <source>across</source>
   <translation>quer</translation>
  </message>
  <message>
   <location filename="ui/views/comparison.py" />
   <source>alone</source>
   <translation>allein</translation>
  </message>
  <message>
   <source>along Dint</source>
   <translation>entlang Dint</translation>
  </message>
  <message>
   <source>along Dmax</source>
   <translation>entlang Dmax</translation>
  </message>
  <message>
   <source>along Dmin</source>
   <translation>entlang Dmin</translation>
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
   <location filename="ui/panels/spectrum.py" />
   <source>amplitude [%]</source>
   <translation>Amplitude [%]</translation>
  </message>
  <message>
   <location filename="ui/panels/tasks.py" />
   <source>and {count} more</source>
   <translation>und {count} weitere</translation>
  </message>
  <message>
   <location filename="ui/dialogs/export.py" />
   <source>as the folder</source>
   <translation>wie der Ordner</translation>
  </message>
  <message>
   <location filename="ui/dialogs/export.py" />
   <source>at most {faces} facets, {triangles} triangles</source>
   <translation>höchstens {faces} Facetten, {triangles} Dreiecken</translation>
  </message>
  <message>
   <location filename="ui/views/triptych.py" />
   <source>at most {reach:.3g} µm from the particle</source>
   <translation>höchstens {reach:.3g} µm vom Partikel entfernt</translation>
  </message>
  <message>
   <source>best</source>
   <translation>beste</translation>
  </message>
  <message>
   <location filename="ui/panels/loss_curve.py" />
   <source>best so far</source>
   <translation>bisher bester</translation>
  </message>
  <message>
   <location filename="ui/widgets/bar_plot.py" />
   <source>category</source>
   <translation>Kategorie</translation>
  </message>
  <message>
   <location filename="ui/widgets/curve_plot.py" />
   <source>curve</source>
   <translation>Kurve</translation>
  </message>
  <message>
   <location filename="ui/panels/spectrum.py" />
   <source>cut off</source>
   <translation>abgeschnitten</translation>
  </message>
  <message>
   <location filename="ui/dialogs/help.py" />
   <source>drawn by OpenGL in the window</source>
   <translation>von OpenGL im Fenster gezeichnet</translation>
  </message>
  <message>
   <location filename="ui/views/facet_pointer.py" />
   <source>facet {number} of {count}: {area:,.4g} µm² ({share:.1%}), normal ({x:.2f}, {y:.2f}, {z:.2f}), {offset:.4g} µm from the centre, {corners} corners</source>
   <translation>Facette {number} von {count}: {area:,.4g} µm² ({share:.1%}), Normale ({x:.2f}, {y:.2f}, {z:.2f}), {offset:.4g} µm von der Mitte, {corners} Ecken</translation>
  </message>
  <message>
   <source>fast</source>
   <translation>schnell</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch_fields.py" />
   <source>folder with {names}</source>
   <translation>Ordner mit {names}</translation>
  </message>
  <message>
   <source>greatest distance of two points</source>
   <translation>größter Abstand zweier Punkte</translation>
  </message>
  <message>
   <location filename="ui/panels/task_list.py" />
   <location filename="ui/panels/tasks.py" />
   <source>held back</source>
   <translation>angehalten</translation>
  </message>
  <message>
   <source>least distance of two parallel tangent planes</source>
   <translation>kleinster Abstand zweier paralleler Tangentialebenen</translation>
  </message>
  <message>
   <source>longest edge of the bounding box</source>
   <translation>längste Kante des Hüllquaders</translation>
  </message>
  <message>
   <location filename="ui/panels/error_bars.py" />
   <source>loss (Eq. 9): {loss:.4g}</source>
   <translation>Verlust (Gl. 9): {loss:.4g}</translation>
  </message>
  <message>
   <location filename="ui/panels/loss_curve.py" />
   <source>lowest {loss:.4g}</source>
   <translation>kleinster {loss:.4g}</translation>
  </message>
  <message>
   <source>mean of |n·x|/|x| over the surface (Bullard and Garboczi)</source>
   <translation>Mittel von |n·x|/|x| über die Oberfläche (Bullard und Garboczi)</translation>
  </message>
  <message>
   <source>middle edge of the bounding box</source>
   <translation>mittlere Kante des Hüllquaders</translation>
  </message>
  <message>
   <location filename="ui/dialogs/export.py" />
   <source>none</source>
   <translation>keine</translation>
  </message>
  <message>
   <location filename="ui/widgets/bar_plot.py" />
   <source>not below {bound:.3g} {unit} (line)</source>
   <translation>nicht unter {bound:.3g} {unit} (Linie)</translation>
  </message>
  <message>
   <location filename="ui/panels/log.py" />
   <source>note</source>
   <translation>Hinweis</translation>
  </message>
  <message>
   <location filename="ui/views/triptych.py" />
   <source>on its way; the very first one takes longer …</source>
   <translation>unterwegs; das allererste dauert länger …</translation>
  </message>
  <message>
   <location filename="ui/dialogs/help.py" />
   <source>pictures, drawn off-screen</source>
   <translation>Bilder, im Speicher gezeichnet</translation>
  </message>
  <message>
   <location filename="ui/panels/loss_curve.py" />
   <source>present</source>
   <translation>aktuell</translation>
  </message>
  <message>
   <location filename="ui/panels/log.py" />
   <source>problem</source>
   <translation>Problem</translation>
  </message>
  <message>
   <source>shortest edge of the bounding box</source>
   <translation>kürzeste Kante des Hüllquaders</translation>
  </message>
  <message>
   <location filename="ui/panels/loss_curve.py" />
   <source>step {at} of {total}</source>
   <translation>Schritt {at} von {total}</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch_fields.py" />
   <source>tcp://HOST:8786 or tls://HOST:8786</source>
   <translation>tcp://HOST:8786 oder tls://HOST:8786</translation>
  </message>
  <message>
   <location filename="ui/dialogs/export.py" />
   <source>the CT particle itself</source>
   <translation>das CT-Partikel selbst</translation>
  </message>
  <message>
   <location filename="ui/dialogs/export.py" />
   <source>the surface of the spherical-harmonics fit at l&lt;sub&gt;max&lt;/sub&gt; = {l_max}</source>
   <translation>die Oberfläche des Fits mit Kugelflächenfunktionen bei l&lt;sub&gt;max&lt;/sub&gt; = {l_max}</translation>
  </message>
  <message>
   <source>to the eye</source>
   <translation>zum Auge</translation>
  </message>
  <message>
   <location filename="ui/pages/explore/section_panel.py" />
   <source>up</source>
   <translation>hoch</translation>
  </message>
  <message>
   <location filename="ui/panels/spectrum.py" />
   <source>up to l&lt;sub&gt;max&lt;/sub&gt; = {l_max}</source>
   <translation>bis l&lt;sub&gt;max&lt;/sub&gt; = {l_max}</translation>
  </message>
  <message>
   <location filename="ui/views/triptych.py" />
   <source>waiting for the coefficients …</source>
   <translation>wartet auf die Koeffizienten …</translation>
  </message>
  <message>
   <location filename="ui/dialogs/export.py" />
   <source>weights, size distribution, descriptors, provenance (JSON)</source>
   <translation>Gewichte, Größenverteilung, Deskriptoren, Herkunft (JSON)</translation>
  </message>
  <message>
   <location filename="ui/views/comparison.py" />
   <source>with fit</source>
   <translation>mit Fit</translation>
  </message>
  <message>
   <location filename="ui/views/comparison.py" />
   <source>with particle</source>
   <translation>mit Partikel</translation>
  </message>
  <message>
   <location filename="ui/views/comparison.py" />
   <source>with polyhedron</source>
   <translation>mit Polyeder</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch.py" />
   <source>{at:,} of {total:,}</source>
   <translation>{at:,} von {total:,}</translation>
  </message>
  <message>
   <location filename="ui/dialogs/export.py" />
   <location filename="ui/panels/tasks.py" />
   <location filename="ui/tour.py" />
   <source>{at} of {total}</source>
   <translation>{at} von {total}</translation>
  </message>
  <message>
   <location filename="ui/views/triptych.py" />
   <source>{count:,} coefficients, {triangles:,} triangles</source>
   <translation>{count:,} Koeffizienten, {triangles:,} Dreiecke</translation>
  </message>
  <message>
   <location filename="ui/views/triptych.py" />
   <source>{count} facets</source>
   <translation>{count} Facetten</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch_fields.py" />
   <source>{count} of the open particles come from no file and cannot be part of a batch.</source>
   <translation>{count} der geöffneten Partikel stammen aus keiner Datei und können nicht Teil eines Stapels sein.</translation>
  </message>
  <message>
   <location filename="ui/commands.py" />
   <source>{count} particles came from no file and are not in it ({names}); export them.</source>
   <translation>{count} Partikel stammen aus keiner Datei und sind nicht darin ({names}); exportieren Sie sie.</translation>
  </message>
  <message>
   <location filename="ui/batches.py" />
   <source>{count} problems are listed in failed.csv.</source>
   <translation>{count} Probleme stehen in failed.csv.</translation>
  </message>
  <message>
   <location filename="ui/views/triptych.py" />
   <source>{count} vertices, {triangles} triangles</source>
   <translation>{count} Ecken, {triangles} Dreiecke</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch.py" />
   <source>{count} workers</source>
   <translation>{count} Arbeitsprozesse</translation>
  </message>
  <message>
   <location filename="ui/dialogs/export.py" />
   <source>{count}, as unit-volume STL files, {size:,.0f} KiB in all</source>
   <translation>{count}, als STL-Dateien mit Einheitsvolumen, zusammen {size:,.0f} KiB</translation>
  </message>
  <message>
   <location filename="ui/shortcuts.py" />
   <source>{keys} already runs “{command}”.</source>
   <translation>{keys} gehört schon zu „{command}“.</translation>
  </message>
  <message>
   <location filename="ui/shortcuts.py" />
   <source>{keys} is needed for typing and for moving about; add Ctrl or Alt.</source>
   <translation>{keys} wird zum Tippen und Bewegen gebraucht; nehmen Sie Strg oder Alt dazu.</translation>
  </message>
  <message>
   <location filename="ui/shortcuts.py" />
   <source>{keys} is no key that a command can have.</source>
   <translation>{keys} ist keine Taste, die ein Befehl haben kann.</translation>
  </message>
  <message>
   <location filename="ui/dialogs/export.py" />
   <source>{method}, seed {seed}</source>
   <translation>{method}, Startwert {seed}</translation>
  </message>
  <message>
   <location filename="ui/projects.py" />
   <source>{name} has changes that are not saved.</source>
   <translation>{name} hat Änderungen, die nicht gespeichert sind.</translation>
  </message>
  <message>
   <location filename="ui/widgets/number_slider.py" />
   <source>{name}, slider</source>
   <translation>{name}, Schieberegler</translation>
  </message>
  <message>
   <location filename="ui/widgets/preset_bar.py" />
   <source>{preset} (modified)</source>
   <translation>{preset} (geändert)</translation>
  </message>
  <message>
   <location filename="ui/dialogs/export.py" />
   <source>{preset}, modified</source>
   <translation>{preset}, geändert</translation>
  </message>
  <message>
   <location filename="ui/views/triptych.py" />
   <source>{size}, {count:,} triangles</source>
   <translation>{size}, {count:,} Dreiecke</translation>
  </message>
  <message>
   <location filename="ui/panels/fit.py" />
   <source>{surface:.2%} of the surface is hidden from the star point; {volume:.2%} of the volume cannot be represented.</source>
   <translation>{surface:.2%} der Oberfläche sind vom Sternpunkt aus verdeckt; {volume:.2%} des Volumens lassen sich nicht darstellen.</translation>
  </message>
  <message>
   <location filename="ui/translation/sentences.py" />
   <source>{surface} of the surface and {volume} of the volume are hidden from the star point and cannot be kept by a radius function.</source>
   <translation>{surface} der Oberfläche und {volume} des Volumens sind vom Sternpunkt aus verdeckt und lassen sich durch keine Radiusfunktion wiedergeben.</translation>
  </message>
  <message>
   <location filename="ui/dialogs/closing.py" />
   <source>{task} is running.</source>
   <translation>In Arbeit: {task}.</translation>
  </message>
  <message>
   <location filename="ui/dialogs/batch.py" />
   <source>{who}, watched at {link}</source>
   <translation>{who}, zu beobachten unter {link}</translation>
  </message>
  <message>
   <source>π^(1/3) (6V)^(2/3) / A (Wadell, true sphericity)</source>
   <translation>π^(1/3) (6V)^(2/3) / A (Wadell, wahre Sphärizität)</translation>
  </message>
 </context>
</TS>
