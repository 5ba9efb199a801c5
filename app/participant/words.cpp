#include "app/participant/words.hpp"

namespace touchtrial::app {
namespace {

constexpr Words kEnglish = {
    .trial_of = "Trial {} of {}",
    .practice_of = "Practice {} of {}",
    .page_of = "Page {} of {}",
    .question_of = "Question {} of {}",
    .next = "Next",
    .back = "Back",
    .skip = "Skip",
    .go_on = "Go on",

    .practice_title = "Practice",
    .practice_again_title = "Practice, once more",
    .practice_text =
        "First a few surfaces to practise on. Feel each of them, then choose its picture.\n\nAfter "
        "each answer you will be told which picture it was.",
    .practice_again_text =
        "Let us go through the practice once more. Take your time: long, even strokes with little "
        "pressure tell the most.",
    .practice_start = "Start practice",

    .ready_title = "Ready?",
    .ready_text = "When you go on, you can feel the surface.",
    .ready_text_mouse =
        "When you go on, the surface appears. Hold the left mouse button to touch it.",
    .ready_keys = "Press Space or Enter when you are ready.",

    .exploring_mouse = "Hold the left button and stroke.   Enter: done.   Space: stop the force.",
    .force = "Pressure",
    .speed = "Speed",
    .too_hard = "Less pressure, please",

    .answer_title = "Which surface did you feel?",
    .answer_spoken_title = "Which surface was it?",
    .answer_spoken_text = "Please say its name. The experimenter enters it.",
    .time_is_up = "Time is up. Please choose what seems most likely.",
    .choose_hint = "Keys 1 to {}, arrows and Enter, or the mouse",
    .changes_once = "You can change your answer once.",
    .now_fixed = "Your answer is now fixed.",
    .feel_again = "Feel again",
    .scale_true = "Pictures in true size",
    .scale_shrunk = "Pictures at {} % of true size",
    .scale_unknown = "Size of the pictures not known: the monitor does not state its own",

    .confidence_title = "How sure are you?",
    .confidence_least = "guessed",
    .confidence_most = "certain",

    .correct_title = "Correct",
    .wrong_title = "Not this time",
    .your_answer = "Your answer",
    .it_was = "It was",
    .it_was_this = "It was this one",

    .break_title = "Time for a break",
    .break_text = "Take your hand off the device and rest for as long as you like.",
    .break_done = "{} of {} trials are done.",

    .pause_title = "A short pause",
    .pause_text = "Please wait a moment. The experimenter will go on shortly.",

    .end_title = "Thank you!",
    .end_text = "That was all. Please tell the experimenter that you have finished.",
    .finish = "Finish",

    .number_hint = "Type a number",
    .text_hint = "Type your answer",
};

constexpr Words kGerman = {
    .trial_of = "Durchgang {} von {}",
    .practice_of = "Übung {} von {}",
    .page_of = "Seite {} von {}",
    .question_of = "Frage {} von {}",
    .next = "Weiter",
    .back = "Zurück",
    .skip = "Überspringen",
    .go_on = "Weiter",

    .practice_title = "Übung",
    .practice_again_title = "Noch eine Übung",
    .practice_text =
        "Zuerst einige Oberflächen zum Üben. Fühlen Sie jede und wählen Sie dann ihr Bild.\n\nNach "
        "jeder Antwort erfahren Sie, welches Bild es war.",
    .practice_again_text =
        "Wir üben noch einmal. Lassen Sie sich Zeit: Lange, gleichmäßige Striche mit wenig Druck "
        "verraten am meisten.",
    .practice_start = "Übung beginnen",

    .ready_title = "Bereit?",
    .ready_text = "Sobald Sie weitergehen, können Sie die Oberfläche fühlen.",
    .ready_text_mouse =
        "Sobald Sie weitergehen, erscheint die Fläche. Halten Sie die linke Maustaste, um sie zu "
        "berühren.",
    .ready_keys = "Drücken Sie die Leertaste oder Enter, wenn Sie bereit sind.",

    .exploring_mouse = "Linke Taste halten und streichen.   Enter: fertig.   Leertaste: Kraft aus.",
    .force = "Druck",
    .speed = "Tempo",
    .too_hard = "Bitte weniger Druck",

    .answer_title = "Welche Oberfläche haben Sie gefühlt?",
    .answer_spoken_title = "Welche Oberfläche war es?",
    .answer_spoken_text = "Bitte nennen Sie ihren Namen. Die Versuchsleitung trägt ihn ein.",
    .time_is_up = "Die Zeit ist um. Bitte wählen Sie, was Ihnen am wahrscheinlichsten scheint.",
    .choose_hint = "Tasten 1 bis {}, Pfeile und Enter oder die Maus",
    .changes_once = "Sie können Ihre Antwort einmal ändern.",
    .now_fixed = "Ihre Antwort steht jetzt fest.",
    .feel_again = "Noch einmal fühlen",
    .scale_true = "Bilder in wahrer Größe",
    .scale_shrunk = "Bilder in {} % der wahren Größe",
    .scale_unknown = "Größe der Bilder unbekannt: Der Bildschirm nennt seine Maße nicht",

    .confidence_title = "Wie sicher sind Sie?",
    .confidence_least = "geraten",
    .confidence_most = "ganz sicher",

    .correct_title = "Richtig",
    .wrong_title = "Diesmal nicht",
    .your_answer = "Ihre Antwort",
    .it_was = "Es war",
    .it_was_this = "Es war dieses",

    .break_title = "Zeit für eine Pause",
    .break_text = "Nehmen Sie die Hand vom Gerät und ruhen Sie sich aus, solange Sie möchten.",
    .break_done = "{} von {} Durchgängen sind geschafft.",

    .pause_title = "Kurze Pause",
    .pause_text = "Bitte warten Sie einen Moment. Die Versuchsleitung macht gleich weiter.",

    .end_title = "Vielen Dank!",
    .end_text = "Das war alles. Bitte sagen Sie der Versuchsleitung, dass Sie fertig sind.",
    .finish = "Beenden",

    .number_hint = "Zahl eingeben",
    .text_hint = "Antwort eingeben",
};

}  // namespace

const Words& words_in(const std::string& language) {
  return language.starts_with("de") ? kGerman : kEnglish;
}

}  // namespace touchtrial::app
